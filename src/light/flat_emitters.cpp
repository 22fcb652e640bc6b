// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Triangles and plane parallelograms.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "light/emitter.h"
#include "light/emitter_sampling.h"
#include "math/sampling.h"

namespace lanthorn {
namespace {

/// A triangle seen from a point. Its directions are sampled uniformly by solid angle (Arvo 1995, in the form of Peters
/// 2021, "BRDF Importance Sampling for Polygonal Lights", section 3).
struct SphericalTriangle {
  std::array<Direction, 3> v;  ///< to its corners
  float det, dots, base;       ///< |v0 v1 v2|, (v0 + v1).v2, 1 + v0.v1
  float solid_angle;           ///< sr, in [0, 2 pi] (van Oosterom & Strackee 1983)

  /// `determinant`: |v0 v1 v2|, computed from the height above the plane, because the triple product of nearly parallel
  /// unit vectors cancels.
  SphericalTriangle(const Direction& v0, const Direction& v1, const Direction& v2, float determinant)
      : v{v0, v1, v2},
        det(determinant),
        dots(dot(v0 + v1, v2)),
        base(1 + dot(v0, v1)),
        solid_angle(2 * std::atan2(det, dots + base)) {}

  /// v2 moves towards v0 until the remaining triangle has the solid angle u.x * all; u.y then
  /// selects a point of the arc from v1 to the moved vertex. h is the direction half way between v0 and the moved
  /// vertex.
  Direction sample(const Vec2& u) const {
    const float half = 0.5f * u.x * solid_angle;
    const float sin = std::sin(half), cos = std::cos(half);
    const Vec3 h = (det * cos - dots * sin) * v[0] + (base * sin) * v[2];
    const float h2 = length_squared(h);
    const Direction moved = h2 > 0 ? (2 * dot(v[0], h) / h2) * h - v[0] : v[0];
    const Vec3 chord = moved - v[1];
    const float one_minus_cos = u.y * 0.5f * length_squared(chord);
    const Vec3 tangent = chord - dot(chord, v[1]) * v[1];
    const float tangent_length = std::sqrt(length_squared(tangent));
    if (!(tangent_length > 0)) return v[1];
    return (1 - one_minus_cos) * v[1] + (safe_sqrt(one_minus_cos * (2 - one_minus_cos)) / tangent_length) * tangent;
  }
};

/// False for small solid angles, for which area sampling is as good, and for receiving points almost in the emitter.
bool is_well_conditioned(float solid_angle) { return solid_angle > 2e-5f && solid_angle < 6.2f; }

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

bool is_far(const ParallelogramEmitter& p, const Point& from) {
  const float size2 = std::max(length_squared(p.a + p.b), length_squared(p.a - p.b));
  return appears_small(size2, distance_squared(from, p.p00 + 0.5f * (p.a + p.b)));
}

/// The two halves on either side of a diagonal, seen from a point.
struct SphericalHalves {
  SphericalTriangle first, second;
  float solid_angle = first.solid_angle + second.solid_angle;

  Direction sample(const Vec2& u) const {
    const float x = u.x * solid_angle;
    if (x < first.solid_angle) return first.sample({x / first.solid_angle, u.y});
    return second.sample({std::min(1.0f, (x - first.solid_angle) / second.solid_angle), u.y});
  }
};

SphericalHalves seen_from(const ParallelogramEmitter& p, const Point& from) {
  const Vec3 to00 = p.p00 - from, to10 = to00 + p.a, to01 = to00 + p.b, to11 = to10 + p.b;
  const float l00 = norm(to00), l10 = norm(to10), l01 = norm(to01), l11 = norm(to11);
  const float volume = std::fabs(dot(p.normal, to00)) * p.area / (l10 * l01);
  const Direction v10 = to10 / l10, v01 = to01 / l01;
  return {{to00 / l00, v10, v01, volume / l00}, {to11 / l11, v01, v10, volume / l11}};
}

/// Intersection of the ray with the plane (Möller & Trumbore 1997), clamped to the parallelogram if rounding put it
/// outside.
std::optional<Point> intersect(const ParallelogramEmitter& p, const Point& from, const Direction& direction) {
  const Vec3 offset = from - p.p00;
  const Vec3 q = cross(direction, p.b);
  const float det = dot(p.a, q);
  const float u = std::clamp(dot(offset, q) / det, 0.0f, 1.0f);
  const float v = std::clamp(dot(direction, cross(offset, p.a)) / det, 0.0f, 1.0f);
  if (!std::isfinite(u + v)) return {};
  return p.p00 + u * p.a + v * p.b;
}

/// Samples the solid angle in which a flat emitter is seen, or its area if it appears small or the angle is ill
/// conditioned.
template <class Flat>
std::optional<EmitterDirection> sample_flat(const Flat& emitter, const Point& from, const Vec2& u) {
  if (is_far(emitter, from)) return direction_to(emitter.sample_area(u), emitter.area, from);
  const auto seen = seen_from(emitter, from);
  if (!is_well_conditioned(seen.solid_angle)) return direction_to(emitter.sample_area(u), emitter.area, from);
  std::optional<EmitterDirection> result;
  const std::optional<Point> hit = intersect(emitter, from, seen.sample(u));
  if (!hit) return result;
  const Vec3 d = *hit - from;
  EmitterDirection& sample = result.emplace();
  sample.point = *hit;
  sample.normal = emitter.normal;
  sample.distance = norm(d);
  sample.wi = d / sample.distance;
  sample.pdf = 1 / seen.solid_angle;
  return result;
}

/// Density of `sample_flat`.
template <class Flat>
float pdf_of_flat(const Flat& emitter, const Point& from, const Point& hit, const Normal& normal_at_hit) {
  if (is_far(emitter, from)) return pdf_by_area(emitter.area, from, hit, normal_at_hit);
  const float solid_angle = seen_from(emitter, from).solid_angle;
  return is_well_conditioned(solid_angle) ? 1 / solid_angle : pdf_by_area(emitter.area, from, hit, normal_at_hit);
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
  return sample_flat(*this, from, u);
}

float TriangleEmitter::pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const {
  return pdf_of_flat(*this, from, hit, normal_at_hit);
}

Bounds TriangleEmitter::bounds() const {
  Bounds b;
  for (const Point& corner : p) b.extend(corner);
  return b;
}

NormalCone TriangleEmitter::normal_cone() const { return {normal, 1}; }

ParallelogramEmitter::ParallelogramEmitter(const Point& p00_, const Point& p10, const Point& p01)
    : p00(p00_), a(p10 - p00_), b(p01 - p00_) {
  const Vec3 across = cross(a, b);
  area = norm(across);
  if (area > 0) normal = across / area;
}

EmitterPoint ParallelogramEmitter::sample_area(const Vec2& u) const { return {p00 + u.x * a + u.y * b, normal}; }

std::optional<Vec2> ParallelogramEmitter::invert_sample_area(const Point& point) const {
  return clamped_to_square(barycentric(p00, p00 + a, p00 + b, point));
}

std::optional<EmitterDirection> ParallelogramEmitter::sample_towards(const Point& from, const Vec2& u) const {
  return sample_flat(*this, from, u);
}

float ParallelogramEmitter::pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const {
  return pdf_of_flat(*this, from, hit, normal_at_hit);
}

Bounds ParallelogramEmitter::bounds() const {
  Bounds box;
  for (const Point& corner : {p00, p00 + a, p00 + b, p00 + a + b}) box.extend(corner);
  return box;
}

NormalCone ParallelogramEmitter::normal_cone() const { return {normal, 1}; }

}  // namespace lanthorn
