// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The primitives of meshes: triangles; points and lines, which are rendered as surfaces; and deformation of vertices by
// morph targets and skins (glTF 2.0 §3.7.2.2, §3.7.3).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/gltf/document.h"
#include "io/gltf/materials.h"
#include "lanthorn/scene_description.h"

namespace lanthorn::gltf {

/// Lines between vertices; a line from a vertex to itself is a point.
using Strokes = std::vector<std::array<std::uint32_t, 2>>;

/// Maximum number of triangles that `thickened` makes of a stroke.
inline constexpr std::size_t triangles_of_stroke = 12;

struct Deformation {
  std::vector<float> weights;          ///< of the morph targets
  std::span<const glm::dmat4> joints;  ///< from the bind pose to the world; empty: the mesh has no skin

  /// True if no vertex moves.
  bool is_none() const;
};

/// The triangles of a primitive with the vertices that they use; or, without triangles, its points and lines.
struct Primitive {
  description::TriangleMesh mesh;
  Strokes strokes;
};

/// A deformed primitive with the attributes that its material needs: texture coordinates as (u, 1 - v), tangents.
/// nullopt, with a warning, if it has nothing to render. Throws Error.
std::optional<Primitive> read_primitive(Document& document, const Value& primitive, const Surface& surface,
                                        const Deformation& deformation);

/// Octahedra for points and six-sided prisms for lines, of the given radius, with smooth normals. `vertices`:
/// positions, texture coordinates and colours; `place` transforms them before they are thickened.
description::TriangleMesh thickened(const description::TriangleMesh& vertices, const Strokes& strokes,
                                    const Transform& place, float radius);

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
