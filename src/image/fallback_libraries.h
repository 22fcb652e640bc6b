// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace lanthorn {

/// Loads the shared libraries of a folder whose names the system does not know, so that modules that need them find
/// them loaded. Those of the system come first: drivers must not meet an older library of the same name.
void load_fallback_libraries(const std::filesystem::path& folder);

/// The folder for them beside the modules of this library, which the relocatable archive has
/// (scripts/bundle-libraries); empty if there is none.
std::filesystem::path folder_of_fallback_libraries();

}  // namespace lanthorn
