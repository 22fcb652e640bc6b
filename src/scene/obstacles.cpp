// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/obstacles.h"

#include <algorithm>
#include <span>

namespace lanthorn {

namespace {

// Limits for one shape and for the whole scene.
constexpr std::size_t most_of_shape = 64, most_of_scene = 4096;

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
  add_groups(boxes.first(lower), most / 2, is_specular, to);
  add_groups(boxes.subspan(lower), most - most / 2, is_specular, to);
}

std::vector<Obstacle> obstacles_of(const ShapeStore& shape, const MaterialTable& materials) {
  std::vector<Obstacle> result;
  const MaterialTable::Traits& traits = materials.traits(shape.record.material);
  if (traits.is_interface || (shape.record.emits && !traits.may_be_specular)) return result;
  std::vector<Bounds> boxes(shape.primitives());
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = shape.bounds_of(static_cast<std::uint32_t>(i));
  add_groups(boxes, most_of_shape, traits.may_be_specular, result);
  return result;
}

std::vector<Bounds> boxes_of(const std::vector<Obstacle>& obstacles, bool is_specular) {
  std::vector<Bounds> boxes;
  for (const Obstacle& o : obstacles)
    if (o.is_specular == is_specular) boxes.push_back(o.box);
  return boxes;
}

}  // namespace

std::vector<Obstacle> find_obstacles(const Geometry& geometry, const MaterialTable& materials) {
  std::vector<Obstacle> all;
  for (const auto& shape : geometry.shapes()) {
    const std::vector<Obstacle> own = obstacles_of(*shape, materials);
    all.insert(all.end(), own.begin(), own.end());
  }
  std::vector<std::vector<Obstacle>> groups;
  for (const auto& group : geometry.groups()) {
    groups.emplace_back();
    for (const auto& shape : group) {
      const std::vector<Obstacle> own = obstacles_of(*shape, materials);
      groups.back().insert(groups.back().end(), own.begin(), own.end());
    }
  }
  for (std::size_t i = 0; i < geometry.placement_count(); ++i)
    for (const Obstacle& o : groups[geometry.placed_group(i).group])
      all.push_back({geometry.swept_bounds(geometry.placed_group(i), o.box), o.is_specular});
  if (all.size() <= most_of_scene) return all;

  std::vector<Obstacle> grouped;
  for (const bool is_specular : {false, true}) {
    std::vector<Bounds> boxes = boxes_of(all, is_specular);
    add_groups(boxes, most_of_scene / 2, is_specular, grouped);
  }
  return grouped;
}

}  // namespace lanthorn
