// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/file_access.h"
#include "description/scene_description.h"

namespace lanthorn {

/// How far a scene file is trusted.
struct ReadOptions {
  /// Reads only files in the tree of the scene file's folder, and shows nothing of what is in them in messages.
  bool sandbox = false;
  std::uint64_t max_pixels = FileAccess::default_max_pixels;  ///< of each image that the scene names
};

/// Reads a scene file; its extension decides how: .pbrt is pbrt-v4, .gltf and .glb are glTF 2.0, .obj is Wavefront OBJ;
/// each may be gzipped and end in .gz. What Lanthorn reads over or replaces is in the description's `warnings`, what it
/// has read in `hash` and `files`. Throws Error with its place (file, line and column; in glTF files file and JSON
/// pointer) if the file, or one that it names, is wrong.
SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options = {});

/// As `read_scene`, for the text of a pbrt-v4 file whose relative file names start in `folder` and which messages call
/// `name`.
SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& folder, const std::string& name);

}  // namespace lanthorn
