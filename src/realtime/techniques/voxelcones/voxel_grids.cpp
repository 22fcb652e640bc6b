// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/voxelcones/voxel_grids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "realtime/scene/projection.h"

namespace lanthorn {

namespace {

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// What 64 rays in the middles of as many parts of the window meet first.
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

VoxelFocus focus_of(const Scene& scene, const View& view) {
  const float time = view.camera.time(0);
  const WindowRays rays = window_rays(view, Vec2(0), Vec2(0.5f), time);
  const std::vector<Point> seen = seen_points(scene, rays, time);
  VoxelFocus focus;
  if (seen.empty()) return focus;
  focus.centre = rays.parallel ? median_of(seen) : rays.eye;
  std::vector<float> distances;
  distances.reserve(seen.size());
  for (const Point& p : seen) distances.push_back(std::sqrt(distance_squared(p, focus.centre)));
  focus.distance = median(std::move(distances));
  return focus;
}

int voxel_grid_limit(int size) {
  // Six directions of four half floats, and an eighth more for each coarser level.
  constexpr std::int64_t most_bytes = std::int64_t{2} << 30, bytes_of_voxel = 6 * 8;
  const std::int64_t voxels = std::int64_t{size} * size * size, bytes = voxels * bytes_of_voxel * 8 / 7;
  return static_cast<int>(std::clamp<std::int64_t>(most_bytes / bytes, 1, most_voxel_grids));
}

std::vector<VoxelGrid> voxel_grids(const Bounds& bounds, int size, const VoxelFocus& focus, int count) {
  constexpr float width_by_distance = 1.5f;
  constexpr int steps = 8;  // of a corner along the grid's edge
  // The surfaces in its middle: the outermost walls lie in the middles of voxels.
  VoxelGrid whole;
  whole.size = size;
  const float widest = bounds.empty() ? 0 : max_component(bounds.extent());
  whole.side = widest > 0 && widest < infinity ? widest / static_cast<float>(size - 3) : 1;
  whole.corner = (bounds.empty() ? Point(0) : bounds.centre()) - 0.5f * whole.edge();
  std::vector<VoxelGrid> grids{whole};
  const int limit = count > 0 ? std::min(count, voxel_grid_limit(size)) : voxel_grid_limit(size);
  while (static_cast<int>(grids.size()) < limit) {
    VoxelGrid next = grids.back();
    next.side *= 0.5f;
    if (count == 0 && !(next.edge() >= width_by_distance * focus.distance)) break;
    const float step = next.edge() / steps;
    for (int axis = 0; axis < 3; ++axis) {
      const float wanted = (focus.centre[axis] - 0.5f * next.edge() - whole.corner[axis]) / step;
      const float last = (whole.edge() - next.edge()) / step;
      next.corner[axis] = whole.corner[axis] + step * std::clamp(std::round(wanted), 0.0f, last);
    }
    grids.push_back(next);
  }
  return grids;
}

}  // namespace lanthorn
