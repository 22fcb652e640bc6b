// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// What the meshes of a scene will take.
struct SceneMemory {
  std::uint64_t triangles = 0;  ///< patches count as two
  double geometry = 0;          ///< bytes of meshes as rays use them
  double trees = 0;             ///< bytes of Embree's trees
  double building = 0;          ///< bytes beside these while the largest tree is built
};

/// Counts meshes as they are described: what displacement and subdivision add is not known before they are made. An
/// object counts once, however many instances it has.
SceneMemory expected_memory(const SceneDescription& scene);

/// Throws Error, with the bytes needed and those available, if the scene's geometry does not fit into memory.
void require_geometry_memory(const SceneDescription& scene);

}  // namespace lanthorn
