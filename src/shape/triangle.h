// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The surface at a hit on a triangle: the hot path of every ray.
// Reference for the bound: Pharr, Jakob, Humphreys 2023, "Physically Based Rendering" 4e, §6.8.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/vec3.hpp>

#include "math/vec.h"
#include "shape/geometry_record.h"

namespace lanthorn {

/// Bound of the relative error of n successive roundings.
constexpr float gamma_bound(int n) {
  constexpr float unit = 0x1p-24f;
  return static_cast<float>(n) * unit / (1 - static_cast<float>(n) * unit);
}

namespace detail {

/// True if a vector with this squared length can be squared in single precision.
inline bool is_squarable(float length2) { return length2 > 1e-30f && length2 < 1e30f; }

/// Normal of a triangle whose squared area is outside the range of single precision.
inline Normal normal_of_extreme(const Vec3& edge1, const Vec3& edge2) {
  const glm::dvec3 n = glm::cross(glm::dvec3(edge1), glm::dvec3(edge2));
  return Normal(n / glm::length(n));
}

}  // namespace detail

inline std::array<Point, 3> corners_of(const GeometryRecord& record, std::uint32_t primitive) {
  const std::array<std::uint32_t, 3>& c = record.triangles[primitive];
  return {record.position(c[0]), record.position(c[1]), record.position(c[2])};
}

inline FlatTriangle flat_triangle(const std::array<Point, 3>& corners, bool flip_normal) {
  const Vec3 edge1 = corners[1] - corners[0], edge2 = corners[2] - corners[0];
  const Vec3 area_normal = cross(edge1, edge2);
  const float area2 = length_squared(area_normal);
  const float inverse_length = 1 / std::sqrt(area2);
  FlatTriangle t;
  t.corners = corners;
  t.normal = detail::is_squarable(area2) ? area_normal * inverse_length : detail::normal_of_extreme(edge1, edge2);
  if (flip_normal) t.normal = -t.normal;
  // The error of the normal, whose components are differences of products.
  const Vec3 a1 = abs(edge1), a2 = abs(edge2);
  const Vec3 products(a1.y * a2.z + a1.z * a2.y, a1.z * a2.x + a1.x * a2.z, a1.x * a2.y + a1.y * a2.x);
  t.off_plane = gamma_bound(3) * inverse_length * products;
  t.most_off_plane = 0x1p-14f * (a1.x + a1.y + a1.z + a2.x + a2.y + a2.z);
  return t;
}

namespace detail {

/// Uvs of a mesh that has none: pbrt's, or those of the patch of which two triangles are the halves.
inline Vec2 default_uv(const GeometryRecord& record, std::uint32_t primitive, float u, float v) {
  return record.quads && primitive % 2 != 0 ? Vec2(u, u + v) : Vec2(u + v, v);
}

/// Position and normals of a point of the triangle.
inline SurfaceGeometry evaluate_flat(const FlatTriangle& t, float b0, float u, float v) {
  const Vec3 w0 = b0 * t.corners[0], w1 = u * t.corners[1], w2 = v * t.corners[2];
  SurfaceGeometry s;
  s.position = w0 + w1 + w2;
  s.normal = s.shading_normal = t.normal;
  // Error bound: rounding of the position, and of the plane equation.
  const Vec3 to_corner = abs(t.corners[0] - s.position);
  const float off_plane = std::min(t.most_off_plane, dot(to_corner, t.off_plane));
  s.error = gamma_bound(7) * (abs(w0) + abs(w1) + abs(w2)) + gamma_bound(4) * to_corner + off_plane * abs(s.normal);
  return s;
}

/// The same with uvs, for a mesh without attributes at its corners.
inline SurfaceGeometry evaluate_plain(const GeometryRecord& record, std::uint32_t primitive, float u, float v) {
  SurfaceGeometry s = evaluate_flat(record.flat[primitive], 1 - u - v, u, v);
  s.uv = default_uv(record, primitive, u, v);
  return s;
}

}  // namespace detail

/// For meshes with attributes at their corners, or whose derivatives are wanted.
SurfaceGeometry evaluate_attributed_triangle(const GeometryRecord& record, std::uint32_t primitive, float u, float v);

/// Height over the facet of the smooth surface that the normals of a triangle's corners describe.
struct Rise {
  Normal normal{0, 0, 1};  ///< of the facet, unit, on the side of `wi`
  float height = 0;        ///< along `normal`; 0 unless the smooth surface bulges out on that side
};
/// The same at a point of a triangle of a mesh with normals, in the shape's space: the mean height of the planes
/// through the corners that are perpendicular to their normals, like the points of Phong tessellation (Boubekeur &
/// Alexa 2008).
Rise rise_over_triangle(const GeometryRecord& record, std::uint32_t primitive, float u, float v, const Vec3& wi);

/// u and v are the barycentric weights of the second and third corner.
inline SurfaceGeometry evaluate_triangle(const GeometryRecord& record, std::uint32_t primitive, float u, float v) {
  if (record.has_vertices() || record.has_colors || record.wants_derivatives())
    return evaluate_attributed_triangle(record, primitive, u, v);
  return detail::evaluate_plain(record, primitive, u, v);
}

}  // namespace lanthorn
