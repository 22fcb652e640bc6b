// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "index/left_balanced_kdtree.h"

#include <algorithm>
#include <bit>

#include "base/parallel.h"

namespace lanthorn {

namespace {

/// Nodes with fewer points are built by one thread.
constexpr std::size_t parallel_points = 1u << 13;

/// Number of nodes under the first child of a left-balanced tree of `count` > 0 nodes. All levels are full except the
/// last, which is filled from the left.
std::size_t first_child_size(std::size_t count) {
  const std::size_t last_level = std::bit_floor(count);  // capacity of the last level
  const std::size_t in_last_level = count - (last_level - 1);
  return (last_level / 2 - std::min<std::size_t>(1, last_level / 2)) + std::min(in_last_level, last_level / 2);
}

}  // namespace

void LeftBalancedKdTree::build_node(std::uint32_t slot, std::span<NumberedPoint> points, SplitRule rule,
                                    std::vector<std::uint32_t>& order) {
  if (points.empty()) return;
  const std::size_t median = first_child_size(points.size());
  const unsigned axis = split_axis(points, rule);
  split_at(points, median, axis);
  nodes_[slot] = points[median].position;
  axes_[slot] = static_cast<std::uint8_t>(axis);
  order[slot] = points[median].number;
  const auto build_first = [&] { build_node(2 * slot + 1, points.first(median), rule, order); };
  const auto build_second = [&] { build_node(2 * slot + 2, points.subspan(median + 1), rule, order); };
  if (points.size() > parallel_points) {
    parallel_invoke(build_first, build_second);
  } else {
    build_first();
    build_second();
  }
}

IndexBuild<LeftBalancedKdTree> LeftBalancedKdTree::build(std::span<const Point> points, SplitRule rule) {
  IndexBuild<LeftBalancedKdTree> built;
  LeftBalancedKdTree& tree = built.index;
  tree.size_ = points.size();
  tree.nodes_ = std::make_unique_for_overwrite<Coordinates[]>(points.size());
  tree.axes_ = std::make_unique_for_overwrite<std::uint8_t[]>(points.size());
  built.order.resize(points.size());
  const auto all = numbered(points);
  tree.build_node(0, std::span(all.get(), points.size()), rule, built.order);
  return built;
}

std::span<const Neighbour> LeftBalancedKdTree::nearest(const Point& p, float max_radius,
                                                       std::span<Neighbour> memory) const {
  struct Pending {
    std::uint32_t slot;
    float plane_dist2;
  };
  const Coordinates query = coordinates_of(p);
  NearestHeap heap(memory, max_radius);
  std::array<Pending, max_depth> pending;
  std::size_t waiting = 0;
  std::uint32_t slot = 0;
  for (;;) {
    while (slot < size_) {
      const Coordinates& node = nodes_[slot];
      heap.offer(distance_squared(point_of(node), p), slot);
      const unsigned axis = axes_[slot];
      const float beyond = query[axis] - node[axis];
      pending[waiting++] = {2 * slot + (beyond < 0 ? 2 : 1), beyond * beyond};
      slot = 2 * slot + (beyond < 0 ? 1 : 2);
    }
    do {
      if (waiting == 0) return heap.found();
      slot = pending[--waiting].slot;
    } while (heap.rejects(pending[waiting].plane_dist2));
  }
}

}  // namespace lanthorn
