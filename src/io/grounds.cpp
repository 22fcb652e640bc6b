// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/grounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "io/surfaces.h"
#include "math/vec.h"

namespace lanthorn {

namespace {

using namespace description;

float size_of(const Bounds& box) { return box.empty() ? 0 : std::sqrt(length_squared(box.extent())); }

// The axis along which a box is thin, if the box is wide along both other axes.
std::optional<int> thin_axis(const Bounds& box) {
  constexpr float thin = 0.05f, wide = 0.1f;
  const Vec3 extent = box.extent();
  std::array<int, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return extent[a] < extent[b]; });
  const float largest = extent[axes[2]];
  if (extent[axes[0]] <= thin * largest && extent[axes[1]] >= wide * largest) return axes[0];
  return {};
}

// Sorted by size, largest first.
std::vector<Part> sorted_parts(const SceneDescription& scene) {
  std::vector<Part> parts = parts_of(scene);
  std::erase_if(parts, [](const Part& part) { return !std::isfinite(size_of(part.box)); });
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return size_of(a.box) > size_of(b.box); });
  return parts;
}

// Direction from the ground to the objects on it. Zero if the box is thin along no axis, or the scene is not thin along
// that axis: then the box is a wall of a room.
Vec3 side_of_ground(const Bounds& box, const Bounds& things, const Bounds& scene) {
  constexpr float far_larger = 4;
  Vec3 side(0);
  const auto axis = thin_axis(box);
  const float size = size_of(box), largest = std::max(size_of(things), axis ? scene.extent()[*axis] : 0.0f);
  if (axis && size_of(things) > 0 && size >= far_larger * largest)
    side[*axis] = things.centre()[*axis] < box.centre()[*axis] ? -1.0f : 1.0f;
  return side;
}

struct FoundGrounds {
  std::size_t count = 0;  ///< the largest `count` parts are grounds
  Vec3 side{0};           ///< direction towards the objects
};

FoundGrounds find_grounds(const std::vector<Part>& parts) {
  std::vector<Bounds> others(parts.size() + 1);  // bounding boxes of the parts from each index on
  for (std::size_t i = parts.size(); i-- > 0;) {
    others[i] = others[i + 1];
    others[i].extend(parts[i].box);
  }
  FoundGrounds found;
  for (std::size_t i = 0; i < parts.size() && thin_axis(parts[i].box); ++i)
    if (side_of_ground(parts[i].box, others[i + 1], others[0]) != Vec3(0)) found.count = i + 1;
  if (found.count == 0) return found;
  const Bounds& things = others[found.count];
  found.side = side_of_ground(parts[0].box, things, others[0]);
  const bool are_alike =
      std::all_of(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(found.count),
                  [&](const Part& part) { return side_of_ground(part.box, things, others[0]) == found.side; });
  return are_alike ? found : FoundGrounds();
}

// Removes the elements at these positions and returns them in ascending order.
template <class T>
std::vector<std::pair<std::size_t, T>> take(std::vector<T>& from, std::vector<std::size_t> places) {
  std::sort(places.begin(), places.end());
  std::vector<std::pair<std::size_t, T>> taken;
  std::vector<T> left;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (taken.size() < places.size() && places[taken.size()] == i)
      taken.emplace_back(i, std::move(from[i]));
    else
      left.push_back(std::move(from[i]));
  }
  from = std::move(left);
  return taken;
}

template <class T>
void insert(std::vector<T>& into, std::vector<std::pair<std::size_t, T>> taken) {
  std::vector<T> all;
  auto next = into.begin();
  for (auto& [place, element] : taken) {
    while (all.size() < place) all.push_back(std::move(*next++));
    all.push_back(std::move(element));
  }
  all.insert(all.end(), std::make_move_iterator(next), std::make_move_iterator(into.end()));
  into = std::move(all);
}

}  // namespace

Grounds::Grounds(SceneDescription& scene) {
  const std::vector<Part> parts = sorted_parts(scene);
  const FoundGrounds found = find_grounds(parts);
  if (found.count == 0) return;
  side_ = found.side;
  std::vector<std::size_t> shapes, instances;
  for (std::size_t i = 0; i < found.count; ++i) (parts[i].is_instance ? instances : shapes).push_back(parts[i].place);
  shapes_ = take(scene.shapes.edit(), std::move(shapes));
  instances_ = take(scene.instances.edit(), std::move(instances));
}

void Grounds::put_back(SceneDescription& scene) {
  if (!side_) return;
  insert(scene.shapes.edit(), std::exchange(shapes_, {}));
  insert(scene.instances.edit(), std::exchange(instances_, {}));
}

}  // namespace lanthorn
