// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/parallelogram_emitter.h"

#include <algorithm>
#include <cmath>

#include "light/emitter_geometry.h"
#include "light/emitter_sampling.h"
#include "light/spherical_triangle.h"

namespace lanthorn {
namespace {

bool is_far(const ParallelogramEmitter& p, const Point& from) {
  const float size2 = std::max(length_squared(p.a + p.b), length_squared(p.a - p.b));
  return appears_small(size2, distance_squared(from, p.p00 + 0.5f * (p.a + p.b)));
}

/// The two halves on either side of a diagonal, seen from a point.
struct SphericalHalves {
  SphericalTriangle first, second;

  float solid_angle() const { return first.solid_angle + second.solid_angle; }
  Direction sample(const Vec2& u) const {
    const float x = u.x * solid_angle();
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

std::optional<EmitterDirection> sample_halves(const ParallelogramEmitter& p, const SphericalHalves& halves,
                                              const Point& from, const Vec2& u) {
  std::optional<EmitterDirection> result;
  const std::optional<Point> hit = intersect(p, from, halves.sample(u));
  if (!hit) return result;
  const Vec3 d = *hit - from;
  EmitterDirection& seen = result.emplace();
  seen.point = *hit;
  seen.normal = p.normal;
  seen.distance = norm(d);
  seen.wi = d / seen.distance;
  seen.pdf = 1 / halves.solid_angle();
  return result;
}

}  // namespace

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
  if (is_far(*this, from)) return direction_to(sample_area(u), area, from);
  const SphericalHalves halves = seen_from(*this, from);
  if (!is_well_conditioned(halves.solid_angle())) return direction_to(sample_area(u), area, from);
  return sample_halves(*this, halves, from, u);
}

float ParallelogramEmitter::pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const {
  if (is_far(*this, from)) return pdf_by_area(area, from, hit, normal_at_hit);
  const float solid_angle = seen_from(*this, from).solid_angle();
  return is_well_conditioned(solid_angle) ? 1 / solid_angle : pdf_by_area(area, from, hit, normal_at_hit);
}

Bounds ParallelogramEmitter::bounds() const {
  Bounds box;
  for (const Point& corner : {p00, p00 + a, p00 + b, p00 + a + b}) box.extend(corner);
  return box;
}

NormalCone ParallelogramEmitter::normal_cone() const { return {normal, 1}; }

}  // namespace lanthorn
