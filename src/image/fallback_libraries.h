// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace lanthorn {

/// Loads the shared libraries of a folder that the system lacks, so that modules that need them find them loaded. The
/// system's libraries take precedence: drivers must not meet an older library of the same name.
void load_fallback_libraries(const std::filesystem::path& folder);

/// The folder of such libraries beside this library's modules, which the relocatable archive has
/// (scripts/bundle-libraries); empty if it does not exist.
std::filesystem::path folder_of_fallback_libraries();

}  // namespace lanthorn
