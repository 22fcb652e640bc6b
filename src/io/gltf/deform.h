// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Deformation of a mesh's vertices: morph targets and skins (glTF 2.0 §3.7.2.2, §3.7.3).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/gltf/document.h"

namespace lanthorn::gltf {

struct Deformation {
  std::vector<float> weights;          ///< of the morph targets
  std::span<const glm::dmat4> joints;  ///< from the bind pose to the world; empty: the mesh has no skin

  /// True if no vertex moves.
  bool is_none() const;
};

/// Adds the weighted targets of a primitive to positions, normals and tangents. `vertices`: indices of the primitive's
/// vertices that the mesh uses. Throws Error.
void morph(Document& document, const Value& primitive, const std::vector<float>& weights,
           const std::vector<std::uint32_t>& vertices, description::TriangleMesh& mesh);

/// For each vertex, the weighted sum of its joints' matrices.
class Skinning {
 public:
  Skinning(std::span<const glm::dmat4> joints, std::size_t vertices);
  /// Adds an influence. Throws Error at `place` if the joint does not exist.
  void add(std::size_t vertex, std::uint32_t joint, float weight, const Value& place);
  /// Transforms positions, normals and tangents from the bind pose to the world.
  void apply(description::TriangleMesh& mesh) const;

 private:
  struct Blend {
    glm::dmat4 sum{0.0};
    double weight = 0;
  };
  std::span<const glm::dmat4> joints_;
  std::vector<Blend> blends_;
};

}  // namespace lanthorn::gltf
