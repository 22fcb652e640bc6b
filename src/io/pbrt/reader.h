// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/known_method.h"
#include "io/pbrt/context.h"
#include "lanthorn/scene.h"

namespace lanthorn::pbrt {

/// Reads a pbrt-v4 scene, or a pbrt-v3 scene, which is translated first. Relative file names are resolved in `folder`.
/// Messages call the file `name`. `methods` checks the parameters of the integrator. Other files are read only through
/// `read_file`. If they are on disk, `access` determines which ones are missing: a single Error names them all, or they
/// are skipped if `access` says so. `observer`, if set, is told the size of the meshes on disk before they are read.
/// Throws Error with file, line and column.
SceneDescription read(std::string_view text, std::filesystem::path folder, const std::string& name, FindMethod methods,
                      FileReader read_file, const FileAccess* access = nullptr, MeshObserver observer = {});

/// Translates a pbrt-v3 scene to pbrt-v4 text whose relative file names are relative to `target`. Included files become
/// part of it. Throws Error as `read` does, and for pbrt-v4 files.
UpgradedScene upgrade(std::string_view text, std::filesystem::path folder, const std::filesystem::path& target,
                      const std::string& name, FileReader read_file);

}  // namespace lanthorn::pbrt
