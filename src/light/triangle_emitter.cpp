// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/triangle_emitter.h"

#include <algorithm>
#include <cmath>

#include "light/emitter_geometry.h"
#include "light/emitter_sampling.h"
#include "light/spherical_triangle.h"
#include "math/sampling.h"

namespace lanthorn {
namespace {

SphericalTriangle seen_from(const TriangleEmitter& t, const Point& from) {
  std::array<Direction, 3> v;
  float lengths = 1;
  for (unsigned i = 0; i < 3; ++i) {
    v[i] = t.p[i] - from;
    const float length = norm(v[i]);
    lengths *= length;
    v[i] /= length;
  }
  return {v[0], v[1], v[2], std::fabs(dot(t.normal, t.p[0] - from)) * 2 * t.area / lengths};
}

/// Intersection of the ray with the triangle's plane (Möller & Trumbore 1997), clamped to the triangle if rounding put
/// it outside.
std::optional<Point> intersect(const TriangleEmitter& t, const Point& from, const Direction& direction) {
  const Vec3 e1 = t.p[1] - t.p[0], e2 = t.p[2] - t.p[0], offset = from - t.p[0];
  const Vec3 q = cross(direction, e2);
  const float det = dot(e1, q);
  const float b1 = std::clamp(dot(offset, q) / det, 0.0f, 1.0f);
  const float b2 = std::clamp(dot(direction, cross(offset, e1)) / det, 0.0f, 1.0f - b1);
  if (!std::isfinite(b1 + b2)) return {};
  return t.p[0] + b1 * e1 + b2 * e2;
}

bool is_far(const TriangleEmitter& t, const Point& from) {
  const Vec3 e1 = t.p[1] - t.p[0], e2 = t.p[2] - t.p[0];
  const float size2 = std::max({length_squared(e1), length_squared(e2), distance_squared(t.p[1], t.p[2])});
  return appears_small(size2, distance_squared(from, t.p[0]));
}

}  // namespace

TriangleEmitter::TriangleEmitter(const Point& p0, const Point& p1, const Point& p2) : p{p0, p1, p2} {
  const Vec3 doubled = cross(p1 - p0, p2 - p0);
  const float length = norm(doubled);
  area = 0.5f * length;
  if (length > 0) normal = doubled / length;
}

EmitterPoint TriangleEmitter::sample_area(const Vec2& u) const {
  const Vec2 b = sample_uniform_triangle(u);
  return {p[0] + b.x * (p[1] - p[0]) + b.y * (p[2] - p[0]), normal};
}

std::optional<Vec2> TriangleEmitter::invert_sample_area(const Point& point) const {
  return clamped_to_square(invert_uniform_triangle(barycentric(p[0], p[1], p[2], point)));
}

std::optional<EmitterDirection> TriangleEmitter::sample_towards(const Point& from, const Vec2& u) const {
  if (is_far(*this, from)) return direction_to(sample_area(u), area, from);
  const SphericalTriangle triangle = seen_from(*this, from);
  if (!is_well_conditioned(triangle.solid_angle)) return direction_to(sample_area(u), area, from);
  const std::optional<Point> hit = intersect(*this, from, triangle.sample(u));
  if (!hit) return {};
  const Vec3 d = *hit - from;
  const float distance = norm(d);
  return EmitterDirection{*hit, normal, d / distance, distance, 1 / triangle.solid_angle};
}

float TriangleEmitter::pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const {
  if (is_far(*this, from)) return pdf_by_area(area, from, hit, normal_at_hit);
  const SphericalTriangle triangle = seen_from(*this, from);
  return is_well_conditioned(triangle.solid_angle) ? 1 / triangle.solid_angle
                                                   : pdf_by_area(area, from, hit, normal_at_hit);
}

Bounds TriangleEmitter::bounds() const {
  Bounds b;
  for (const Point& corner : p) b.extend(corner);
  return b;
}

NormalCone TriangleEmitter::normal_cone() const { return {normal, 1}; }

}  // namespace lanthorn
