// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lanthorn/file.h"
#include "staging/stand_ins.h"

namespace lanthorn::obj {

/// Reads a Wavefront OBJ file and the MTL files that it names. Relative file names are resolved in `folder`. Messages
/// call the file `name`. Other files are read only through `read_file`. If they are on disk, `access` determines which
/// ones are missing: a single Error names all missing images, or they are skipped if `access` says so; a missing MTL
/// file causes a warning. Throws Error with file, line and column.
ModelFile read(std::string_view text, const std::filesystem::path& folder, const std::string& name,
               FileReader read_file, const FileAccess* access = nullptr);

}  // namespace lanthorn::obj
