// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "shape/triangle.h"

namespace lanthorn {

namespace {

const std::array<Vec2, 3> default_triangle_uvs{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)};

std::array<Vec2, 3> triangle_uvs(const GeometryRecord& record, std::uint32_t primitive,
                                 const std::array<std::uint32_t, 3>& corners) {
  if (record.has_uvs)
    return {record.vertices[corners[0]].uv, record.vertices[corners[1]].uv, record.vertices[corners[2]].uv};
  if (!record.quads) return default_triangle_uvs;
  // The two halves of a patch over the unit square: p00 p10 p11 and p00 p11 p01.
  if (primitive % 2 == 0) return default_triangle_uvs;
  return {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)};
}

constexpr float rise_share = 0.5f;

// Sets the derivatives of the linear map from (u, v) to the triangle; leaves them 0 if the parametrisation is
// degenerate.
void set_derivatives(SurfaceGeometry& s, const Vec3& edge1, const Vec3& edge2, const std::array<Vec2, 3>& uv) {
  const Vec2 duv1 = uv[1] - uv[0];
  const Vec2 duv2 = uv[2] - uv[0];
  const float determinant = duv1.x * duv2.y - duv1.y * duv2.x;
  if (std::fabs(determinant) < 1e-9f * std::fmax(dot(duv1, duv1), dot(duv2, duv2))) return;
  s.dpdu = (duv2.y * edge1 - duv1.y * edge2) / determinant;
  s.dpdv = (duv1.x * edge2 - duv2.x * edge1) / determinant;
}

}  // namespace

SurfaceGeometry evaluate_attributed_triangle(const GeometryRecord& record, std::uint32_t primitive, float u, float v) {
  const float b0 = 1 - u - v;
  SurfaceGeometry s =
      record.has_vertices()
          ? detail::evaluate_flat(flat_triangle(corners_of(record, primitive), record.flip_normal), b0, u, v)
          : detail::evaluate_flat(record.flat[primitive], b0, u, v);
  const std::array<std::uint32_t, 3>& corners = record.triangles[primitive];
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
  s.uv = record.has_uvs ? b0 * record.vertices[corners[0]].uv + u * record.vertices[corners[1]].uv +
                              v * record.vertices[corners[2]].uv
                        : detail::default_uv(record, primitive, u, v);
  if (record.wants_derivatives()) {
    const std::array<Point, 3> p = corners_of(record, primitive);
    set_derivatives(s, p[1] - p[0], p[2] - p[0], triangle_uvs(record, primitive, corners));
    s.tangent = record.tangents != nullptr ? b0 * record.tangents[corners[0]] + u * record.tangents[corners[1]] +
                                                 v * record.tangents[corners[2]]
                                           : s.dpdu;
  }
  return s;
}

Rise rise_over_triangle(const GeometryRecord& record, std::uint32_t primitive, float u, float v, const Vec3& wi) {
  const std::array<std::uint32_t, 3>& corners = record.triangles[primitive];
  const std::array<float, 3> weights{1 - u - v, u, v};
  const FlatTriangle facet = flat_triangle(corners_of(record, primitive), record.flip_normal);
  const Point p = weights[0] * facet.corners[0] + weights[1] * facet.corners[1] + weights[2] * facet.corners[2];
  Rise result{dot(facet.normal, wi) < 0 ? -facet.normal : facet.normal};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Normal& n = record.vertices[corners[i]].normal;  // its length and sign do not matter
    result.height += weights[i] * dot(facet.corners[i] - p, n) * dot(n, result.normal) / length_squared(n);
  }
  // Normals that all tilt alike describe no bulge: the heights cancel.
  result.height = std::max(0.0f, rise_share * result.height);
  return result;
}

}  // namespace lanthorn
