// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/profile.h"

namespace lanthorn {

DirectionMap::DirectionMap(const Transform& light_to_world) {
  const glm::mat3 linear(light_to_world.matrix);
  const float size = std::cbrt(std::fabs(glm::determinant(linear)));
  to_world = linear / size;
  to_light = glm::mat3(light_to_world.inverse) * size;
}

// A linear map M of determinant 1 divides the solid angle around the unit vector d by |M d|³.

DirectionMap::Mapped DirectionMap::world_from_light(const Direction& local) const {
  const Vec3 d = to_world * local;
  const float length2 = length_squared(d), length = std::sqrt(length2);
  return {d / length, length * length2};
}

DirectionMap::Mapped DirectionMap::light_from_world(const Direction& world) const {
  const Vec3 d = to_light * world;
  const float length2 = length_squared(d), length = std::sqrt(length2);
  return {d / length, 1 / (length * length2)};
}

}  // namespace lanthorn
