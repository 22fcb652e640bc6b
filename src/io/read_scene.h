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
  /// Reads only files below the scene file's folder, and shows nothing of their content in messages.
  bool sandbox = false;
  std::uint64_t max_pixels = FileAccess::default_max_pixels;  ///< of each image that the scene names
};

/// Reads a scene file. The extension determines the format: .pbrt is pbrt-v4, .gltf and .glb are glTF 2.0, .obj is
/// Wavefront OBJ; each may be gzipped and end in .gz. The description's `warnings` list what was ignored or replaced;
/// `hash` and `files` identify what was read. Throws Error with its place (file, line and column; in glTF files file
/// and JSON pointer) if the file, or one that it names, is wrong.
SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options = {});

/// As `read_scene`, for the text of a pbrt-v4 file. Relative file names start at `folder`. Messages call the text
/// `name`.
SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& folder, const std::string& name);

}  // namespace lanthorn
