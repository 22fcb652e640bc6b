// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Memory that triangles and curves of a scene take, known before it is allocated.
#pragma once

#include <cstdint>

#include "shape/geometry_record.h"
#include "shape/triangle.h"

namespace lanthorn {

/// Bytes of Embree's tree per triangle, and further bytes while it is built. Measured on height fields of one and four
/// million triangles with Embree 3.13 (docs/lab/memory.md, "Memory of geometry").
constexpr double tree_bytes_per_triangle = 66, building_bytes_per_triangle = 44;

/// The same for curves, per segment; for ribbons, per piece that a segment is cut into. Measured on 200,000 curves of
/// each kind.
constexpr double tree_bytes_per_curve = 116, tree_bytes_per_ribbon_piece = 47, building_bytes_per_curve = 45;
constexpr std::uint32_t ribbon_pieces = 4;

/// Bytes of a mesh as rays use it, without its tree. Meshes without normals and uvs keep positions and the triangles
/// themselves; other meshes keep vertices with all attributes.
constexpr double mesh_bytes(double vertices, double triangles, bool has_attributes) {
  constexpr double corners = 3 * sizeof(std::uint32_t);
  return has_attributes ? vertices * sizeof(Vertex) + triangles * corners
                        : vertices * sizeof(Point) + triangles * (corners + sizeof(FlatTriangle));
}

}  // namespace lanthorn
