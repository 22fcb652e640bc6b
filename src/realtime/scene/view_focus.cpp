// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/scene/view_focus.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "realtime/scene/projection.h"

namespace lanthorn {

namespace {

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The first hits of 64 rays through the middles of as many parts of the window.
std::vector<Point> seen_points(const Scene& scene, const WindowRays& rays, float time) {
  constexpr int rows = 8;
  std::vector<Point> seen;
  for (int i = 0; i < rows * rows; ++i) {
    const int column = i % rows, row = i / rows;
    const float x = (static_cast<float>(column) + 0.5f) / rows, y = (static_cast<float>(row) + 0.5f) / rows;
    const Vec3 through = rays.corner + x * rays.right + y * rays.down;
    Ray ray;
    ray.origin = rays.parallel ? through : rays.eye;
    ray.direction = rays.parallel ? rays.axis : normalize(through);
    ray.time = time;
    if (const auto at = scene.intersect(ray, Wavelengths{})) seen.push_back(at->position);
  }
  return seen;
}

Point median_of(const std::vector<Point>& points) {
  Point middle{0};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> along;
    along.reserve(points.size());
    for (const Point& p : points) along.push_back(p[axis]);
    middle[axis] = median(std::move(along));
  }
  return middle;
}

}  // namespace

ViewFocus focus_of(const Scene& scene, const View& view) {
  const float time = view.camera.time(0);
  const WindowRays rays = window_rays(view, Vec2(0), Vec2(0.5f), time);
  const std::vector<Point> seen = seen_points(scene, rays, time);
  ViewFocus focus;
  if (seen.empty()) return focus;
  focus.centre = rays.parallel ? median_of(seen) : rays.eye;
  std::vector<float> distances;
  distances.reserve(seen.size());
  for (const Point& p : seen) distances.push_back(std::sqrt(distance_squared(p, focus.centre)));
  focus.distance = median(std::move(distances));
  return focus;
}

float seen_radius(const Scene& scene, const View& view) {
  constexpr float most_distances = 4;
  return std::min(scene.bounding_sphere().radius, most_distances * focus_of(scene, view).distance);
}

}  // namespace lanthorn
