// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Spheres, cylinders and disks, whole or clipped, under any affine map. All computations are in double precision and in
// object space: hits are as exact as the scene's single-precision coordinates allow.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "lanthorn/scene_description.h"
#include "math/affine.h"
#include "math/vec.h"

namespace lanthorn {

struct Quadric {
  enum class Kind : std::uint8_t { sphere, cylinder, disk };
  Kind kind = Kind::sphere;
  double radius = 1;
  double inner_radius = 0;       ///< disk
  double z_min = -1, z_max = 1;  ///< disk: both are its height
  double phi_max = 2 * std::numbers::pi;
  Affine to_world;  ///< for a shape of an object: to the object's space
  /// Radius in the space of `to_world` of a whole sphere that remains one there; 0 for all other quadrics. Such a
  /// sphere needs no map: its centre is where `to_world` moves the origin.
  double ball_radius = 0;
  double rounding_slack = 0;  ///< error bound of mapping rays and points to object space and back, metres

  static Quadric from(const description::Sphere& s, const Transform& to_world);
  static Quadric from(const description::Disk& d, const Transform& to_world);
  static Quadric from(const description::Cylinder& c, const Transform& to_world);

  /// Bounding box in the space of `to_world`.
  Bounds bounds() const;
  bool is_whole_sphere() const;
};

/// Distances along the ray, in units of the direction's length, ascending: only hits on the clipped surface and inside
/// (t_min, t_max).
struct QuadricRoots {
  int count = 0;
  std::array<double, 2> t{};
};

namespace quadric_detail {

struct Roots {
  bool real = false;
  double t0 = 0, t1 = 0;
};

/// Solves |o + t d|² = r², with o and d two-dimensional (z = 0) or three-dimensional. The discriminant is computed at
/// the point nearest to the centre, so that it does not cancel for distant origins.
inline Roots circle_roots(const DVec3& o, const DVec3& d, double radius) {
  const double a = glm::dot(d, d);
  if (!(a > 0)) return {};
  const double half_b = -glm::dot(o, d);
  const double c = glm::dot(o, o) - radius * radius;
  // Early exit without division: most rays that meet the bounds clearly miss the circle or have it behind them.
  const double cancelled = 1e-12 * (glm::dot(o, o) + radius * radius) * a;
  if (c * a - half_b * half_b > cancelled || (c > 0 && half_b < 0)) return {};
  const DVec3 nearest = o + (half_b / a) * d;
  const double discriminant = a * (radius * radius - glm::dot(nearest, nearest));
  if (!(discriminant >= 0)) return {};
  const double q = half_b + std::copysign(std::sqrt(discriminant), half_b);
  if (q == 0) return {true, 0, 0};
  const double t0 = c / q;
  const double t1 = q / a;
  return {true, std::min(t0, t1), std::max(t0, t1)};
}

/// The roots inside (t_min, t_max) whose points are kept.
template <class Keep>
QuadricRoots roots_within(const Roots& roots, float t_min, float t_max, Keep&& keeps) {
  QuadricRoots result;
  if (!roots.real) return result;
  const auto add = [&](double t) {
    if (t > t_min && t < t_max && keeps(t)) result.t[static_cast<unsigned>(result.count++)] = t;
  };
  add(roots.t0);
  if (roots.t1 != roots.t0) add(roots.t1);
  return result;
}

QuadricRoots intersect_mapped(const Quadric& q, const Vec3& origin, const Vec3& direction, float t_min, float t_max);

}  // namespace quadric_detail

/// `origin` and `direction` in the space that `to_world` maps to.
inline QuadricRoots intersect(const Quadric& q, const Vec3& origin, const Vec3& direction, float t_min, float t_max) {
  using namespace quadric_detail;
  if (!(q.ball_radius > 0)) return intersect_mapped(q, origin, direction, t_min, t_max);
  const Roots roots = circle_roots(DVec3(origin) - q.to_world.translation, DVec3(direction), q.ball_radius);
  return roots_within(roots, t_min, t_max, [](double) { return true; });
}

/// The surface at a point on it.
struct QuadricPoint {
  DVec3 position{0.0};  ///< in the space that `to_world` maps to, moved onto the surface
  DVec3 normal{0.0};    ///< dp/du x dp/dv of the object-space parametrisation, as a normal in that space; unit
};
QuadricPoint evaluate(const Quadric& q, const DVec3& near);
/// Texture coordinates of a point on the surface.
Vec2 evaluate_uv(const Quadric& q, const DVec3& near);
/// Tangents of the surface at a point on it, in the space that `to_world` maps to.
struct QuadricTangents {
  DVec3 around{0.0};           ///< along dp/du, or any tangent where dp/du is 0; not normalised
  DVec3 dpdu{0.0}, dpdv{0.0};  ///< dp/du is 0 on the axis
};
QuadricTangents evaluate_tangents(const Quadric& q, const DVec3& near);
}  // namespace lanthorn
