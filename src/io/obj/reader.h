// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/stand_ins.h"
#include "lanthorn/file.h"

namespace lanthorn::obj {

/// Reads a Wavefront OBJ file and the MTL files that it names. Relative file names start at `folder`. Messages call the
/// file `name`. Other files are read through `read_file` only. If they are on disk, `access` tells which are missing:
/// images are named together, or left out if it says so; a missing MTL file is a warning. Throws Error with file, line
/// and column.
ModelFile read(std::string_view text, const std::filesystem::path& folder, const std::string& name,
               FileReader read_file, const FileAccess* access = nullptr);

}  // namespace lanthorn::obj
