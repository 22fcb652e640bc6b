// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Emitters of pbrt's quadrics.
#include "light/emitter.h"

#include <algorithm>
#include <cmath>

#include "light/emitter_sampling.h"
#include "math/frame.h"
#include "math/sampling.h"

namespace lanthorn {

namespace {

/// The cone of directions from an outside point to a sphere.
struct SphereCone {
  float distance;       ///< to the centre
  float sin2;           ///< of the half angle
  float one_minus_cos;  ///< of the half angle; computed from the sine, because it is small far away
};
SphereCone sphere_cone(float distance, float radius) {
  const float sin2 = sqr(radius / distance);
  const float cos = std::sqrt((distance - radius) * (distance + radius)) / distance;
  return {distance, sin2, sin2 / (1 + cos)};
}

/// The cone of directions from `from` to a round sphere. Nullopt if `from` is inside, or so close to the surface that
/// it may lie on it: rounding puts surface points that see the inside on either side.
std::optional<SphereCone> cone_towards(const SphereEmitter& sphere, const Point& from) {
  if (!(sphere.world_radius > 0)) return {};
  const float distance = norm(sphere.centre - from);
  const float rounding = 0x1p-20f * max_component(abs(from) + abs(sphere.centre));
  if (!(distance > sphere.world_radius + rounding)) return {};
  return sphere_cone(distance, sphere.world_radius);
}

}  // namespace

SphereEmitter::SphereEmitter(const Transform& object_to_world, float radius_, float z_min_, float z_max_,
                             float phi_max_)
    : linear(object_to_world.matrix),
      centre(object_to_world.point(Point(0))),
      radius(radius_),
      z_min(std::clamp(std::fmin(z_min_, z_max_), -radius_, radius_)),
      z_max(std::clamp(std::fmax(z_min_, z_max_), -radius_, radius_)),
      phi_max(std::clamp(phi_max_, 0.0f, 2 * pi)),
      max_stretch(lanthorn::max_stretch(linear, 3)) {
  // Integrates over the polar angle, because the integrand is smooth at the poles.
  const float theta0 = std::acos(z_max / radius), theta1 = std::acos(z_min / radius);
  const float mean = max_stretch == 0
                         ? stretch(linear, {0, 0, 1}) * (z_max - z_min) / radius
                         : (theta1 - theta0) * integrate(64, [&](const Vec2& u) {
                             const float theta = lerp(u.x, theta0, theta1), phi = u.y * phi_max;
                             const float sin = std::sin(theta);
                             return sin * stretch(linear, {sin * std::cos(phi), sin * std::sin(phi), std::cos(theta)});
                           });
  area = phi_max * radius * radius * mean;
  const bool whole = z_min == -radius && z_max == radius && phi_max > 2 * pi * (1 - 1e-6f);
  if (whole && max_stretch == 0) world_radius = radius * std::cbrt(std::fabs(glm::determinant(linear)));
}

EmitterPoint SphereEmitter::sample_area(const Vec2& u) const {
  const auto normal_at = [&](const Vec2& x) {
    const float z = lerp(x.x, z_min, z_max), phi = x.y * phi_max;
    const float r = safe_sqrt((radius - z) * (radius + z));
    return Vec3(r * std::cos(phi), r * std::sin(phi), z) / radius;
  };
  const Vec2 x = sample_by_stretch(u, linear, max_stretch, normal_at);
  const Normal n = normal_at(x);
  return {linear * (radius * n) + centre, map_normal(linear, n)};
}

std::optional<Vec2> SphereEmitter::invert_sample_area(const Point& point) const {
  if (max_stretch != 0 || world_radius > 0) return {};
  const Vec3 p = glm::inverse(linear) * (point - centre);
  return clamped_to_square({(p.z - z_min) / (z_max - z_min), turn_around_z(p.x, p.y) * (2 * pi / phi_max)});
}

std::optional<EmitterDirection> SphereEmitter::sample_towards(const Point& from, const Vec2& u) const {
  const std::optional<SphereCone> cone = cone_towards(*this, from);
  if (!cone) return direction_to(sample_area(u), area, from);
  const float distance = cone->distance;
  const Frame frame((centre - from) / distance);
  const float h = u.x * cone->one_minus_cos;
  const float sin2 = h * (2 - h), sin = std::sqrt(sin2), cos = 1 - h;
  const float phi = 2 * pi * u.y;
  const Vec3 around = std::cos(phi) * frame.s + std::sin(phi) * frame.t;
  // The nearer root, from the product of both roots: their difference would cancel near the sphere.
  const float ratio = std::min(1.0f, sin2 / cone->sin2);
  const float half_chord = std::sqrt(1 - ratio);  // in radii
  const float t = (distance - world_radius) * (distance + world_radius) / (distance * cos + world_radius * half_chord);
  const float cos_centre = std::sqrt(cone->sin2) * ratio + cos * half_chord;
  const Normal outwards = normalize(-cos_centre * frame.n + (t * sin / world_radius) * around);
  return EmitterDirection{centre + world_radius * outwards, outwards, cos * frame.n + sin * around, t,
                          pdf_uniform_cone(cone->one_minus_cos)};
}

float SphereEmitter::pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const {
  const std::optional<SphereCone> cone = cone_towards(*this, from);
  return cone ? pdf_uniform_cone(cone->one_minus_cos) : pdf_by_area(area, from, hit, normal_at_hit);
}

Bounds SphereEmitter::bounds() const {
  return box_around(centre, radius * half_extent(linear[0], linear[1], linear[2]));
}

NormalCone SphereEmitter::normal_cone() const { return {}; }

CylinderEmitter::CylinderEmitter(const Transform& object_to_world, float radius_, float z_min_, float z_max_,
                                 float phi_max_)
    : linear(object_to_world.matrix),
      origin(object_to_world.point(Point(0))),
      radius(radius_),
      z_min(std::fmin(z_min_, z_max_)),
      z_max(std::fmax(z_min_, z_max_)),
      phi_max(std::clamp(phi_max_, 0.0f, 2 * pi)),
      max_stretch(lanthorn::max_stretch(linear, 2)) {
  const float mean = integrate(64, [&](const Vec2& u) {
    const float phi = u.x * phi_max;
    return stretch(linear, {std::cos(phi), std::sin(phi), 0});
  });
  area = radius * phi_max * (z_max - z_min) * mean;
}

EmitterPoint CylinderEmitter::sample_area(const Vec2& u) const {
  const auto normal_at = [&](const Vec2& x) {
    const float phi = x.y * phi_max;
    return Vec3(std::cos(phi), std::sin(phi), 0);
  };
  const Vec2 x = sample_by_stretch(u, linear, max_stretch, normal_at);
  const Normal n = normal_at(x);
  return {linear * (radius * n + Vec3(0, 0, lerp(x.x, z_min, z_max))) + origin, map_normal(linear, n)};
}

std::optional<Vec2> CylinderEmitter::invert_sample_area(const Point& point) const {
  if (max_stretch != 0) return {};
  const Vec3 p = glm::inverse(linear) * (point - origin);
  return clamped_to_square({(p.z - z_min) / (z_max - z_min), turn_around_z(p.x, p.y) * (2 * pi / phi_max)});
}

Bounds CylinderEmitter::bounds() const {
  const Vec3 half = radius * half_extent(linear[0], linear[1]);
  Bounds b = box_around(origin + z_min * linear[2], half);
  b.extend(box_around(origin + z_max * linear[2], half));
  return b;
}

NormalCone CylinderEmitter::normal_cone() const { return {}; }

DiskEmitter::DiskEmitter(const Transform& object_to_world, float height, float radius_, float inner_radius_,
                         float phi_max_)
    : centre(object_to_world.point({0, 0, height})),
      axis_x(object_to_world.vector({1, 0, 0})),
      axis_y(object_to_world.vector({0, 1, 0})),
      normal(map_normal(glm::mat3(object_to_world.matrix), {0, 0, 1})),
      radius(radius_),
      inner_radius(inner_radius_),
      phi_max(std::clamp(phi_max_, 0.0f, 2 * pi)),
      area(0.5f * phi_max * (radius - inner_radius) * (radius + inner_radius) * norm(cross(axis_x, axis_y))) {}

EmitterPoint DiskEmitter::sample_area(const Vec2& u) const {
  Vec2 p;
  if (is_whole()) {
    p = radius * sample_concentric_disk(u);
  } else {
    const float r = std::sqrt(lerp(u.x, inner_radius * inner_radius, radius * radius)), phi = u.y * phi_max;
    p = r * Vec2(std::cos(phi), std::sin(phi));
  }
  return {centre + p.x * axis_x + p.y * axis_y, normal};
}

std::optional<Vec2> DiskEmitter::invert_sample_area(const Point& point) const {
  const Vec2 p = barycentric(centre, centre + axis_x, centre + axis_y, point);
  if (is_whole()) return clamped_to_square(invert_concentric_disk(p / radius));
  const float inner2 = inner_radius * inner_radius;
  return clamped_to_square(
      {(dot(p, p) - inner2) / (radius * radius - inner2), turn_around_z(p.x, p.y) * (2 * pi / phi_max)});
}

Bounds DiskEmitter::bounds() const { return box_around(centre, radius * half_extent(axis_x, axis_y)); }

NormalCone DiskEmitter::normal_cone() const { return {normal, 1}; }

}  // namespace lanthorn
