// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The nodes of the scene: their transforms, at rest or animated, and the places of their meshes.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "io/gltf/document.h"

namespace lanthorn::gltf {

/// The local transforms and morph weights of a file's nodes: at rest, or at a time of the first animation.
class Pose {
 public:
  /// The rest pose without `seconds`. Before and after a channel's keys, its first or last value applies. Throws Error.
  Pose(Document& document, std::optional<double> seconds);

  glm::dmat4 local_transform(std::size_t node) const;
  /// Weights of the targets of the node's mesh, one per target; weights that the file omits are 0.
  std::vector<float> morph_weights(std::size_t node) const;

 private:
  /// Animated values, which replace the node's own.
  struct Animated {
    std::optional<std::vector<double>> translation, rotation, scale, weights;
  };
  void animate(const Value& animation, double seconds);
  void animate_channel(const Value& animation, const Value& channel, double seconds);

  Document& document_;
  std::map<std::size_t, Animated> animated_;
};

/// Composes scale, rotation (a quaternion x, y, z, w of any length) and translation, applied in this order.
glm::dmat4 from_parts(const glm::dvec3& translation, const std::vector<double>& rotation, const glm::dvec3& scale);

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
