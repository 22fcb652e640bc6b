// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Memory that triangles of a scene take, known before it is allocated.
#pragma once

#include <cstdint>

#include "shape/geometry_record.h"
#include "shape/triangle.h"

namespace lanthorn {

/// Bytes of Embree's tree for each triangle, and bytes beside them while it is built. Measured on height fields of one
/// and four million triangles with Embree 3.13 (docs/performance.md, "Memory of geometry").
constexpr double tree_bytes_per_triangle = 66, building_bytes_per_triangle = 44;

/// Bytes of a mesh as rays use it, without its tree. Meshes without normals and uvs keep positions and the triangles
/// themselves, others keep vertices with all attributes.
constexpr double mesh_bytes(double vertices, double triangles, bool has_attributes) {
  constexpr double corners = 3 * sizeof(std::uint32_t);
  return has_attributes ? vertices * sizeof(Vertex) + triangles * corners
                        : vertices * sizeof(Point) + triangles * (corners + sizeof(FlatTriangle));
}

}  // namespace lanthorn
