// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/triangle_emitter.h"

#include <algorithm>
#include <cmath>

#include "light/emitter_geometry.h"
#include "light/emitter_sampling.h"
#include "math/sampling.h"

namespace lanthorn {
namespace {

/// The triangle seen from a point as a spherical triangle.
struct SphericalTriangle {
  std::array<Direction, 3> v;
  float det, dots, base;  ///< |v0 v1 v2|, (v0 + v1).v2, 1 + v0.v1
  float solid_angle;      ///< sr, in [0, 2 pi] (van Oosterom & Strackee 1983)

  SphericalTriangle(const TriangleEmitter& t, const Point& from) {
    float lengths = 1;
    for (unsigned i = 0; i < 3; ++i) {
      v[i] = t.p[i] - from;
      const float length = norm(v[i]);
      lengths *= length;
      v[i] /= length;
    }
    // From the height above the plane: the determinant of nearly parallel unit vectors would cancel.
    det = std::fabs(dot(t.normal, t.p[0] - from)) * 2 * t.area / lengths;
    dots = dot(v[0] + v[1], v[2]);
    base = 1 + dot(v[0], v[1]);
    solid_angle = 2 * std::atan2(det, dots + base);
  }

  /// False for small solid angles, for which area sampling is as good, and for points that lie almost in the triangle.
  bool well_conditioned() const { return solid_angle > 2e-5f && solid_angle < 6.2f; }

  /// Peters 2021, §3: v2 moves towards v0 until the remaining triangle has the solid angle u.x * all; u.y then selects
  /// a point of the arc from v1 to the moved vertex. h is the direction half way between v0 and the moved vertex.
  Direction sample(const Vec2& u) const {
    const float half = 0.5f * u.x * solid_angle;
    const float sin = std::sin(half), cos = std::cos(half);
    const Vec3 h = (det * cos - dots * sin) * v[0] + (base * sin) * v[2];
    const float h2 = length_squared(h);
    const Direction moved = h2 > 0 ? (2 * dot(v[0], h) / h2) * h - v[0] : v[0];
    const Vec3 chord = moved - v[1];
    const float one_minus_cos = u.y * 0.5f * length_squared(chord);
    const Vec3 tangent = chord - dot(chord, v[1]) * v[1];
    const float tangent_length = norm(tangent);
    if (!(tangent_length > 0)) return v[1];
    return (1 - one_minus_cos) * v[1] + (safe_sqrt(one_minus_cos * (2 - one_minus_cos)) / tangent_length) * tangent;
  }
};

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

/// True if the triangle appears so small from `from` that cosine and distance hardly vary over it. Area sampling is
/// then about as good as solid-angle sampling at a third of its cost. Far means beyond four times the longest edge.
bool is_far(const TriangleEmitter& t, const Point& from) {
  const Vec3 e1 = t.p[1] - t.p[0], e2 = t.p[2] - t.p[0];
  const float size2 = std::max({length_squared(e1), length_squared(e2), distance_squared(t.p[1], t.p[2])});
  return distance_squared(from, t.p[0]) > 16 * size2;
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
  const SphericalTriangle triangle(*this, from);
  if (!triangle.well_conditioned()) return direction_to(sample_area(u), area, from);
  const std::optional<Point> hit = intersect(*this, from, triangle.sample(u));
  if (!hit) return {};
  const Vec3 d = *hit - from;
  const float distance = norm(d);
  return EmitterDirection{*hit, normal, d / distance, distance, 1 / triangle.solid_angle};
}

float TriangleEmitter::pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const {
  if (is_far(*this, from)) return pdf_by_area(area, from, hit, normal_at_hit);
  const SphericalTriangle triangle(*this, from);
  return triangle.well_conditioned() ? 1 / triangle.solid_angle : pdf_by_area(area, from, hit, normal_at_hit);
}

Bounds TriangleEmitter::bounds() const {
  Bounds b;
  for (const Point& corner : p) b.extend(corner);
  return b;
}

NormalCone TriangleEmitter::normal_cone() const { return {normal, 1}; }

}  // namespace lanthorn
