// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lanthorn/file.h"
#include "lanthorn/scene_description.h"

namespace lanthorn::obj {

/// Reads a Wavefront OBJ file and the MTL files that it names. `folder`: where relative file names start; `name`: the
/// file's name in messages; `read_file`: the only access to other files. Throws Error with file, line and column.
SceneDescription read(std::string_view text, const std::filesystem::path& folder, const std::string& name,
                      FileReader read_file);

}  // namespace lanthorn::obj
