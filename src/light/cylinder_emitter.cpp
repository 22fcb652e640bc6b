// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/cylinder_emitter.h"

#include <algorithm>
#include <cmath>

#include "light/emitter_geometry.h"
#include "light/emitter_sampling.h"
#include "math/sampling.h"

namespace lanthorn {
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

}  // namespace lanthorn
