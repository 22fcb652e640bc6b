// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "io/gltf/document.h"
#include "io/gltf/pose.h"

namespace lanthorn::gltf {

/// A node of the scene with its transform to world space.
struct PlacedNode {
  std::size_t node = 0;  ///< index into "nodes"
  glm::dmat4 to_world{1.0};
};

/// All nodes of the scene, parents before children. Throws Error if a node is reached twice.
std::vector<PlacedNode> placed_nodes(Document& document, const Pose& pose);

/// The transforms of a node's mesh: one, or all transforms of EXT_mesh_gpu_instancing. Singular transforms (scale 0)
/// are omitted.
std::vector<Transform> mesh_places(Document& document, const PlacedNode& placed);

}  // namespace lanthorn::gltf
