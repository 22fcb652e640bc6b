// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_data.h"

#include <algorithm>
#include <span>
#include <vector>

#include "base/parallel.h"

namespace lanthorn {

namespace {

// Limits for one shape, for the whole scene, and for all placed groups before the scene's groups are merged.
constexpr std::size_t fewest_in_parallel = std::size_t{1} << 14;
constexpr std::size_t most_of_shape = 64, most_of_scene = 4096, most_of_placements = std::size_t{1} << 18;

// Splits the boxes at the median of their longest axis until there are at most `most` groups.
void add_groups(std::span<Bounds> boxes, std::size_t most, bool is_specular, std::vector<Obstacle>& to) {
  if (boxes.empty()) return;
  Bounds all, centres;
  for (const Bounds& b : boxes) {
    all.extend(b);
    centres.extend(b.centre());
  }
  if (boxes.size() == 1 || most <= 1) {
    to.push_back({all, is_specular});
    return;
  }
  const Vec3 extent = centres.extent();
  const int axis = extent.x >= std::max(extent.y, extent.z) ? 0 : extent.y >= extent.z ? 1 : 2;
  const auto middle = boxes.begin() + static_cast<std::ptrdiff_t>(boxes.size() / 2);
  std::nth_element(boxes.begin(), middle, boxes.end(),
                   [axis](const Bounds& a, const Bounds& b) { return a.centre()[axis] < b.centre()[axis]; });
  const auto lower = static_cast<std::size_t>(middle - boxes.begin());
  if (boxes.size() < fewest_in_parallel) {
    add_groups(boxes.first(lower), most / 2, is_specular, to);
    add_groups(boxes.subspan(lower), most - most / 2, is_specular, to);
    return;
  }
  std::vector<Obstacle> upper;
  parallel_invoke([&] { add_groups(boxes.first(lower), most / 2, is_specular, to); },
                  [&] { add_groups(boxes.subspan(lower), most - most / 2, is_specular, upper); });
  to.insert(to.end(), upper.begin(), upper.end());
}

std::vector<Obstacle> obstacles_of(const ShapeStore& shape, const MaterialTable& materials) {
  std::vector<Obstacle> result;
  const MaterialTraits& traits = materials.traits(shape.record.material);
  if (traits.is_interface || (shape.record.emits && !traits.may_be_specular)) return result;
  std::vector<Bounds> boxes(shape.primitives());
  parallel_chunks(boxes.size(), fewest_in_parallel, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) boxes[i] = shape.bounds_of(static_cast<std::uint32_t>(i));
  });
  add_groups(boxes, most_of_shape, traits.may_be_specular, result);
  return result;
}

// Obstacles of all shapes, in their order.
template <class Shapes>
std::vector<Obstacle> obstacles_of_all(const Shapes& shapes, const MaterialTable& materials) {
  std::vector<std::vector<Obstacle>> found(shapes.size());
  parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) { found[i] = obstacles_of(*shapes[i], materials); });
  std::vector<Obstacle> all;
  for (const std::vector<Obstacle>& of_shape : found) all.insert(all.end(), of_shape.begin(), of_shape.end());
  return all;
}

std::vector<Bounds> boxes_of(const std::vector<Obstacle>& obstacles, bool is_specular) {
  std::vector<Bounds> boxes;
  for (const Obstacle& o : obstacles)
    if (o.is_specular == is_specular) boxes.push_back(o.box);
  return boxes;
}

std::vector<Obstacle> grouped(const std::vector<Obstacle>& obstacles, std::size_t most) {
  if (obstacles.size() <= most) return obstacles;
  std::vector<Obstacle> result;
  for (const bool is_specular : {false, true}) {
    std::vector<Bounds> boxes = boxes_of(obstacles, is_specular);
    add_groups(boxes, most / 2, is_specular, result);
  }
  return result;
}

}  // namespace

std::vector<Obstacle> find_obstacles(const Geometry& geometry, const MaterialTable& materials) {
  const std::size_t placements = geometry.placement_count();
  std::vector<std::vector<Obstacle>> groups;
  for (const auto& group : geometry.groups())
    groups.push_back(
        grouped(obstacles_of_all(group, materials), most_of_placements / std::max(placements, std::size_t{1})));
  std::vector<Obstacle> all = obstacles_of_all(geometry.shapes(), materials);
  for (std::size_t i = 0; i < placements; ++i)
    for (const Obstacle& o : groups[geometry.placed_group(i).group])
      all.push_back({geometry.swept_bounds(geometry.placed_group(i), o.box), o.is_specular});
  return grouped(all, most_of_scene);
}

}  // namespace lanthorn
