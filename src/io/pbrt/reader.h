// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/pbrt/context.h"

namespace lanthorn::pbrt {

/// Reads a pbrt-v4 scene. Relative file names start at `folder`. Messages call the file `name`. Other files are read
/// through `read_file` only. If they are on disk, `access` tells which are missing: these are named together, or left
/// out if it says so. Throws Error with file, line and column.
SceneDescription read(std::string_view text, std::filesystem::path folder, const std::string& name,
                      FileReader read_file, const FileAccess* access = nullptr);

}  // namespace lanthorn::pbrt
