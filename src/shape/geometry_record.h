// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "lanthorn/scene_description.h"
#include "math/vec.h"
#include "medium/medium.h"
#include "shape/quadric.h"

namespace lanthorn {

/// A corner of a mesh with normals or uvs; stored together so that a hit touches one cache line per corner.
struct alignas(32) Vertex {
  Point position{0};
  Normal normal{0};  ///< not normalised
  Vec2 uv{0};
};
static_assert(sizeof(Vertex) == 32);

/// The data of a triangle without normals and uvs at its corners that a hit needs, in one cache line.
struct alignas(64) FlatTriangle {
  std::array<Point, 3> corners;
  Normal normal{0};  ///< geometric, unit, outside
  /// Bound of the error of the plane equation that a ray leaving the triangle is tested with: the distances to the
  /// first corner, per axis, times `off_plane`, at most `most_off_plane` (m).
  Vec3 off_plane{0};
  float most_off_plane = 0;
};
static_assert(sizeof(FlatTriangle) == 64);

/// The data of a geometry that a hit needs, in one cache line. Pointers refer to the record's ShapeStore; null if the
/// mesh lacks the attribute.
struct alignas(64) GeometryRecord {
  enum class Kind : std::uint8_t { triangles, patches, quadric, curves };

  const std::array<std::uint32_t, 3>* triangles = nullptr;
  union {
    const Vertex* vertices = nullptr;  ///< for meshes with normals or uvs
    const FlatTriangle* flat;          ///< for the triangles of meshes without them
  };
  const Point* positions = nullptr;  ///< for meshes without normals and uvs, instead of `vertices`
  const Vec3* tangents = nullptr;
  union {
    const Quadric* quadric = nullptr;
    const std::array<std::uint32_t, 4>* patches;
    const glm::vec4* colors;  ///< of triangles, if has_colors
    const description::Curves* curves;
  };
  std::uint32_t material = 0;
  std::uint32_t first_light = 0;  ///< light of primitive 0, the others follow; for shapes in world space
  Kind kind = Kind::triangles;
  bool flip_normal = false;  ///< outside is opposite to the normal of the winding or the parametrisation
  bool emits = false;
  bool wants_tangents = false;   ///< the material is anisotropic or has a relief
  bool wants_footprint = false;  ///< the material averages textures over footprints
  bool wants_uv = false;         ///< some parameter depends on the place; cheap texture coordinates are computed anyway
  bool has_normals = false;
  bool has_uvs = false;
  bool has_colors = false;
  bool quads = false;             ///< triangles 2 i and 2 i + 1 are patch i
  bool lit_in_pairs = false;      ///< triangles 2 i and 2 i + 1 are one parallelogram, and light i of the shape
  bool is_interface : 1 = false;  ///< no surface, only an interface between media
  bool is_hidden : 1 = false;     ///< rays from the camera pass through
  MediumInterface media;

  bool wants_derivatives() const { return wants_tangents || wants_footprint; }
  bool has_vertices() const { return has_normals || has_uvs; }
  const Point& position(std::uint32_t corner) const {
    return has_vertices() ? vertices[corner].position : positions[corner];
  }
};
static_assert(sizeof(GeometryRecord) == 64);

/// True for curves that face every ray.
inline bool is_flat(const GeometryRecord& record) {
  return record.kind == GeometryRecord::Kind::curves && record.curves->kind == description::CurveKind::flat;
}

/// A surface point before its material is evaluated.
struct SurfaceGeometry {
  Point position{0};
  Vec3 error{0};     ///< bound of the rounding error of `position`, per axis
  Normal normal{0};  ///< geometric, unit, outside
  Normal shading_normal{0};
  Vec2 uv{0};          ///< of quadrics only if the record wants them
  glm::vec4 color{1};  ///< of the mesh's vertices
  // 0 unless the record wants derivatives.
  Vec3 tangent{0};        ///< desired direction of the shading frame's s: the mesh's tangent, or dp/du
  Vec3 dpdu{0}, dpdv{0};  ///< 0 where the parametrisation is degenerate
};

}  // namespace lanthorn
