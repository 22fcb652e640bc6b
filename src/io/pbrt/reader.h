// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/pbrt/context.h"

namespace lanthorn::pbrt {

/// Reads a pbrt-v4 scene. `folder`: where its relative file names start; `name`: the file's name in messages;
/// `read_file`: the only access to other files. `access`: to files on disk; all that are missing are then named at
/// once, or left out if it says so. Throws Error with file, line and column.
SceneDescription read(std::string_view text, std::filesystem::path folder, const std::string& name,
                      FileReader read_file, const FileAccess* access = nullptr);

}  // namespace lanthorn::pbrt
