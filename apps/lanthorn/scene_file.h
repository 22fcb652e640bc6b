// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "scene/description.h"
#include "scene/scene.h"

namespace lanthorn {

struct SceneFile {
  SceneDescription description;
  std::uint64_t hash = 0;  ///< of the file's bytes
};

/// Reads a scene and identifies it. Throws Error.
SceneFile read_scene_file(const std::filesystem::path& path);

/// Counts, bounds, memory, lights and materials of a built scene, for `info` and `render --json`.
nlohmann::json describe_scene(const Scene& scene);

}  // namespace lanthorn
