// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The only file that includes Embree.
#pragma once

#include <embree3/rtcore.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "math/vec.h"

namespace lanthorn::embree {

inline void intersect(RTCScene scene, RTCRayHit& hit) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &hit);
}
inline void occluded(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}

/// Largest coordinate of a ray's origin or direction that Embree accepts. Beyond it, rays are not `is_valid`: Embree
/// asserts this if built with assertions, as Debian's is, and otherwise finds no hit (kernels/common/ray.h,
/// RayK::valid).
inline constexpr float largest_coordinate = 1.844e18f;

inline bool is_valid(const RTCRay& ray) {
  const auto in_range = [](float x) { return std::fabs(x) <= largest_coordinate; };  // false for NaN
  return in_range(ray.org_x) && in_range(ray.org_y) && in_range(ray.org_z) && in_range(ray.dir_x) &&
         in_range(ray.dir_y) && in_range(ray.dir_z) && ray.time >= 0 && !std::isnan(ray.tfar);
}

inline RTCRay make_ray(const Point& origin, const Vec3& direction, float t_max, float time) {
  // Stores four numbers at once: Embree reads four at once, and would stall on separate stores.
  using Four = float __attribute__((vector_size(16)));
  static_assert(offsetof(RTCRay, tnear) == 3 * sizeof(float) && offsetof(RTCRay, time) == 7 * sizeof(float));
  constexpr float t_min = std::numeric_limits<float>::min();  // more than 0: a ray may start exactly on a plane
  struct {
    Four start, way;
  } const line{{origin.x, origin.y, origin.z, t_min}, {direction.x, direction.y, direction.z, time}};
  RTCRay ray;
  std::memcpy(&ray, &line, sizeof line);
  ray.tfar = t_max;
  ray.mask = ~0u;
  ray.id = 0;
  ray.flags = 0;
  return ray;
}

}  // namespace lanthorn::embree
