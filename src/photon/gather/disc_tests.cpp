// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/gather/disc_tests.h"

#include <cmath>
#include <optional>

#include "photon/gather/kernels.h"

namespace lanthorn {

bool is_flat_and_clear(const PathContext& path, const SurfaceVertex& vertex, float radius) {
  const SurfacePoint& at = vertex.at;
  const Normal normal = dot(at.normal, vertex.wi) < 0 ? -at.normal : at.normal;
  constexpr int edge_points = 8;
  const float height = search_flatness * radius;
  const Frame frame(normal);
  for (int i = 0; i < edge_points; ++i) {
    const float angle = 2 * pi * static_cast<float>(i) / edge_points;
    const Point above = at.position + frame.to_world({radius * std::cos(angle), radius * std::sin(angle), height});
    const Vec3 way = above - at.position;
    const float length = std::sqrt(length_squared(way));
    path.counts.shadow += 1;
    if (!path.scene.visible(spawn_ray_to(at, way / length, {above}))) return false;
    path.counts.walk += 1;
    const std::optional<SurfacePoint> below = path.scene.intersect({above, -normal, 2 * height, at.time}, path.w);
    if (!below || std::fabs(dot(below->normal, normal)) < 0.9f) return false;
  }
  return true;
}

}  // namespace lanthorn
