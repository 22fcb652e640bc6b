// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reference: Pharr, Jakob, Humphreys 2023, "Physically Based Rendering" 4e, §6.8.6.
#include "scene/surface_point.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lanthorn {

namespace {

// The neighbouring float in the direction of `offset`'s sign, because the sum may have been rounded the other way.
float rounded_away(float x, float offset) {
  if (x == 0) return offset == 0 ? x : std::copysign(std::numeric_limits<float>::denorm_min(), offset);
  // Without branches: which coordinates of normals are 0, and their signs, nobody can predict.
  const std::uint32_t away = (x > 0) == (offset > 0) ? 1u : ~0u, step = offset == 0 ? 0u : away;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) + step);
}

// Fraction of the distance to a light that is tested: beyond it, a rounded ray may hit the light itself.
constexpr float before_light = 1 - 1e-4f;

}  // namespace

Point offset_origin(const SurfacePoint& at, const Direction& direction) {
  const float distance = dot(abs(at.normal), at.position_error);
  const Vec3 offset = (dot(direction, at.normal) < 0 ? -distance : distance) * at.normal;
  const Point p = at.position + offset;
  return {rounded_away(p.x, offset.x), rounded_away(p.y, offset.y), rounded_away(p.z, offset.z)};
}

Ray spawn_ray(const SurfacePoint& at, const Direction& direction) {
  return {offset_origin(at, direction), direction, infinity, at.time};
}

Ray spawn_ray_to(const SurfacePoint& at, const Direction& direction, const Point& target, float distance) {
  if (!std::isfinite(distance)) return spawn_ray(at, direction);
  // Aims at the target from the ray's actual origin; otherwise rays miss close lights.
  const Point origin = offset_origin(at, direction);
  const Vec3 way = target - origin;
  const float length = std::sqrt(length_squared(way));
  if (!(length > 0)) return {origin, direction, 0, at.time};
  return {origin, way / length, length * before_light, at.time};
}

}  // namespace lanthorn
