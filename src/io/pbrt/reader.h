// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/known_method.h"
#include "io/pbrt/context.h"
#include "lanthorn/expected_meshes.h"
#include "lanthorn/scene.h"

namespace lanthorn::pbrt {

/// Reads a pbrt-v4 scene, or one of pbrt-v3, which is translated first. Relative file names start at `folder`. Messages
/// call the file `name`. `methods` checks the parameters of the integrator. Other files are read through `read_file`
/// only. If they are on disk, `access` tells which are missing: these are named together, or left out if it says so.
/// `observer`, if any, is told of the meshes on disk before they are read. Throws Error with file, line and column.
SceneDescription read(std::string_view text, std::filesystem::path folder, const std::string& name, FindMethod methods,
                      FileReader read_file, const FileAccess* access = nullptr, MeshObserver observer = {});

/// The translation of a pbrt-v3 scene alone, as text of pbrt-v4 whose relative file names start at `target`. Included
/// files become part of it. Throws Error as `read` does, and for pbrt-v4 files.
UpgradedScene upgrade(std::string_view text, std::filesystem::path folder, const std::filesystem::path& target,
                      const std::string& name, FileReader read_file);

}  // namespace lanthorn::pbrt
