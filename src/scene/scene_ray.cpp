// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_ray.h"

#include <fmt/format.h>

#include <cmath>

#include "lanthorn/error.h"

namespace lanthorn {

Ray ray_in_scene(const Scene& scene, const SceneRay& ray, std::size_t index) {
  const float length = glm::length(ray.direction);
  const Point origin = Point(DVec3(ray.origin) - scene.description().origin);
  const bool is_usable = std::isfinite(length) && length > 0 && std::isfinite(glm::dot(origin, Vec3(1)));
  if (!is_usable)
    throw Error(fmt::format(
        "ray {}: expected finite numbers and a direction that is not 0, got origin ({}, {}, {}) "
        "and direction ({}, {}, {})",
        index, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z));
  const description::Camera& camera = scene.description().view.camera;
  return {origin, ray.direction / length, infinity, camera.shutter_open};
}

}  // namespace lanthorn
