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

inline const std::array<Vec2, 3> default_triangle_uvs{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)};

inline std::array<Vec2, 3> triangle_uvs(const GeometryRecord& record, std::uint32_t primitive,
                                        const std::array<std::uint32_t, 3>& corners) {
  if (record.has_uvs)
    return {record.vertices[corners[0]].uv, record.vertices[corners[1]].uv, record.vertices[corners[2]].uv};
  if (!record.quads) return default_triangle_uvs;
  // The two halves of a patch over the unit square: p00 p10 p11 and p00 p11 p01.
  if (primitive % 2 == 0) return default_triangle_uvs;
  return {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)};
}

// Sets the derivatives of the linear map from (u, v) to the triangle; leaves them 0 if the parametrisation is
// degenerate.
inline void set_derivatives(SurfaceGeometry& s, const Vec3& edge1, const Vec3& edge2, const std::array<Vec2, 3>& uv) {
  const Vec2 duv1 = uv[1] - uv[0];
  const Vec2 duv2 = uv[2] - uv[0];
  const float determinant = duv1.x * duv2.y - duv1.y * duv2.x;
  if (std::fabs(determinant) < 1e-9f * std::fmax(dot(duv1, duv1), dot(duv2, duv2))) return;
  s.dpdu = (duv2.y * edge1 - duv1.y * edge2) / determinant;
  s.dpdv = (duv1.x * edge2 - duv2.x * edge1) / determinant;
}

}  // namespace detail

inline std::array<Point, 3> corners_of(const GeometryRecord& record, std::uint32_t primitive) {
  const std::array<std::uint32_t, 3>& c = record.triangles[primitive];
  return {record.position(c[0]), record.position(c[1]), record.position(c[2])};
}

/// u and v are the barycentric weights of the second and third corner.
inline SurfaceGeometry evaluate_triangle(const GeometryRecord& record, std::uint32_t primitive, float u, float v) {
  const std::array<std::uint32_t, 3>& corners = record.triangles[primitive];
  const Point& p0 = record.position(corners[0]);
  const Point& p1 = record.position(corners[1]);
  const Point& p2 = record.position(corners[2]);
  const float b0 = 1 - u - v;
  const Vec3 w0 = b0 * p0, w1 = u * p1, w2 = v * p2;
  const Vec3 edge1 = p1 - p0, edge2 = p2 - p0;
  const Vec3 area_normal = cross(edge1, edge2);
  const float area2 = length_squared(area_normal);
  const float inverse_length = 1 / std::sqrt(area2);

  SurfaceGeometry s;
  s.position = w0 + w1 + w2;
  s.normal = detail::is_squarable(area2) ? area_normal * inverse_length : detail::normal_of_extreme(edge1, edge2);
  if (record.flip_normal) s.normal = -s.normal;

  // Error bound: rounding of the position, and of the plane equation that a ray leaving from here is tested with. The
  // latter is the distance to the first corner times the error of the normal, whose components are differences of
  // products.
  const Vec3 to_corner = abs(p0 - s.position);
  const Vec3 a1 = abs(edge1), a2 = abs(edge2);
  const Vec3 products(a1.y * a2.z + a1.z * a2.y, a1.z * a2.x + a1.x * a2.z, a1.x * a2.y + a1.y * a2.x);
  const float off_plane = std::fmin(gamma_bound(3) * dot(to_corner, products) * inverse_length,
                                    0x1p-14f * (a1.x + a1.y + a1.z + a2.x + a2.y + a2.z));
  s.error = gamma_bound(7) * (abs(w0) + abs(w1) + abs(w2)) + gamma_bound(4) * to_corner + off_plane * abs(s.normal);

  s.shading_normal = s.normal;
  if (record.has_normals) {
    const Normal n = b0 * record.vertices[corners[0]].normal + u * record.vertices[corners[1]].normal +
                     v * record.vertices[corners[2]].normal;
    const float n2 = length_squared(n);
    if (detail::is_squarable(n2)) {
      s.shading_normal = n * (1 / std::sqrt(n2));
      if (dot(s.normal, s.shading_normal) < 0) s.normal = -s.normal;
    }
  }
  if (record.has_colors)
    s.color = b0 * record.colors[corners[0]] + u * record.colors[corners[1]] + v * record.colors[corners[2]];
  if (record.has_uvs || record.wants_tangents) {
    const std::array<Vec2, 3> uv = detail::triangle_uvs(record, primitive, corners);
    s.uv = b0 * uv[0] + u * uv[1] + v * uv[2];
    if (record.wants_tangents) {
      detail::set_derivatives(s, edge1, edge2, uv);
      s.tangent = record.tangents != nullptr ? b0 * record.tangents[corners[0]] + u * record.tangents[corners[1]] +
                                                   v * record.tangents[corners[2]]
                                             : s.dpdu;
    }
  } else {
    s.uv = record.quads ? (primitive % 2 == 0 ? Vec2(u + v, v) : Vec2(u, u + v)) : Vec2(u + v, v);
  }
  return s;
}

}  // namespace lanthorn
