// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Spheres, cylinders and disks, whole or clipped, under any affine map. All computations are in double precision and in
// object space: hits are as exact as the scene's single-precision coordinates allow.
#pragma once

#include <array>
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
/// `origin` and `direction` in the space that `to_world` maps to.
QuadricRoots intersect(const Quadric& q, const Vec3& origin, const Vec3& direction, float t_min, float t_max);

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
/// Error bound of mapping rays and points to object space and back, metres.
double rounding_slack(const Quadric& q);

}  // namespace lanthorn
