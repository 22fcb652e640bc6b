// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/disk_emitter.h"

#include <algorithm>
#include <cmath>

#include "light/emitter_geometry.h"
#include "light/emitter_sampling.h"
#include "math/sampling.h"

namespace lanthorn {
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
