// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A cache-friendly kd-tree after Hooley: the median is in the middle of the array, and both halves are sorted
// recursively.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "index/kd_split.h"
#include "index/nearest_heap.h"
#include "index/point_index.h"
#include "index/slot_points.h"
#include "math/vec.h"

namespace lanthorn {

/// A kd-tree whose nodes are ranges of slots, halved down to leaves of 16 - 32 points that are tested together. Splits
/// are in heap order: the children of node i are 2i and 2i + 1. A node's range follows from its position and is not
/// stored.
class BucketKdTree {
 public:
  static constexpr std::uint32_t leaf_size = 32;  ///< maximum number of points in a leaf

  /// Points must be finite, fewer than 2^31.
  static IndexBuild<BucketKdTree> build(std::span<const Point> points, SplitRule rule = SplitRule::largest_extent);

  /// See `PointIndex`.
  template <class Visit>
  void for_each_near(const Point& p, float radius, Visit&& visit) const;

  /// See `NearestIndex`.
  std::span<const Neighbour> nearest(const Point& p, float max_radius, std::span<Neighbour> heap) const;

  /// Slots of the leaf whose region contains p. These points are close to p, but not always the closest; empty if the
  /// index is empty.
  SlotRange leaf_around(const Point& p) const;
  /// Calls `visit(range)` for the slots of each leaf, in ascending order.
  template <class Visit>
  void for_each_leaf(Visit&& visit) const {
    visit_leaves(root(), visit);
  }

  /// Calls `visit(range, numbers)` for each leaf, in parallel: its slots, and, in ascending order, the numbers of the
  /// balls that may contain points of the leaf. For locality, neighbouring balls should have neighbouring numbers.
  template <class Visit>
  void for_each_leaf_in(std::span<const Ball> balls, Visit&& visit) const;

  std::size_t size() const { return points_.size(); }
  Point position(std::uint32_t slot) const { return points_[slot]; }
  /// Positions and splits, bytes.
  std::size_t memory_bytes() const { return points_.memory_bytes() + leaves_ * sizeof(Split); }

 private:
  /// Points of the first child have coordinates <= position, points of the second >= position.
  struct Split {
    float position;
    std::uint32_t axis;
  };
  struct Node {
    std::uint32_t number, begin, end;
  };
  static constexpr std::size_t max_depth = 32;
  /// Nodes with fewer points are handled by one thread.
  static constexpr std::uint32_t parallel_size = 1u << 13;

  bool is_leaf(const Node& n) const { return n.number >= leaves_; }
  /// First slot of the second child of [begin, end), chosen so that all leaves except the last fill whole vectors.
  static std::uint32_t middle(std::uint32_t begin, std::uint32_t end) {
    return begin + ((end - begin) / 2 + SlotPoints::width - 1) / SlotPoints::width * SlotPoints::width;
  }
  static Node first_child(const Node& n) { return {2 * n.number, n.begin, middle(n.begin, n.end)}; }
  static Node second_child(const Node& n) { return {2 * n.number + 1, middle(n.begin, n.end), n.end}; }
  Node root() const { return {1, 0, static_cast<std::uint32_t>(size())}; }

  template <class Visit>
  void visit_leaves(const Node& node, Visit& visit) const;
  template <class Visit>
  void visit_leaves_in(const Node& node, std::span<const Ball> balls, std::span<const std::uint32_t> numbers,
                       Visit& visit) const;
  template <class Candidates>
  std::span<const Neighbour> search(const Point& p, Candidates&& candidates) const;

  void build_node(const Node& node, NumberedPoint* points, SplitRule rule, std::vector<std::uint32_t>& order);

  std::uint32_t leaves_ = 1;
  std::unique_ptr<Split[]> splits_;  ///< of nodes 1 .. leaves_ - 1
  SlotPoints points_;
};

template <class Visit>
void BucketKdTree::for_each_near(const Point& p, float radius, Visit&& visit) const {
  const float reach = safe_reach(radius);
  const Coordinates low = coordinates_of(p - Vec3(reach)), high = coordinates_of(p + Vec3(reach));
  std::array<Node, max_depth> pending;
  std::array<SlotRange, 32> ranges;
  std::size_t waiting = 0, count = 0;
  Node node = root();
  if (node.end == 0) return;
  for (;;) {
    while (!is_leaf(node)) {
      const Split& split = splits_[node.number];
      const bool first = low[split.axis] <= split.position, second = high[split.axis] >= split.position;
      pending[waiting] = second_child(node);
      waiting += static_cast<std::size_t>(first && second);
      node = first ? first_child(node) : second_child(node);
    }
    const bool adjacent = count > 0 && ranges[count - 1].end == node.begin;
    if (adjacent) {
      ranges[count - 1].end = node.end;
    } else {
      if (count == ranges.size()) {
        points_.for_each_near(ranges, p, radius * radius, visit);
        count = 0;
      }
      ranges[count++] = {node.begin, node.end};
    }
    if (waiting == 0) break;
    node = pending[--waiting];
  }
  points_.for_each_near(std::span(ranges.data(), count), p, radius * radius, visit);
}

template <class Visit>
void BucketKdTree::visit_leaves(const Node& node, Visit& visit) const {
  if (is_leaf(node)) {
    if (node.end > node.begin) visit(SlotRange{node.begin, node.end});
    return;
  }
  visit_leaves(first_child(node), visit);
  visit_leaves(second_child(node), visit);
}

template <class Visit>
void BucketKdTree::for_each_leaf_in(std::span<const Ball> balls, Visit&& visit) const {
  std::vector<std::uint32_t> all(balls.size());
  std::iota(all.begin(), all.end(), 0u);
  visit_leaves_in(root(), balls, all, visit);
}

template <class Visit>
void BucketKdTree::visit_leaves_in(const Node& node, std::span<const Ball> balls,
                                   std::span<const std::uint32_t> numbers, Visit& visit) const {
  if (is_leaf(node)) {
    if (node.end > node.begin) visit(SlotRange{node.begin, node.end}, numbers);
    return;
  }
  const Split& split = splits_[node.number];
  std::vector<std::uint32_t> first(numbers.size()), second(numbers.size());
  std::size_t in_first = 0, in_second = 0;
  for (const std::uint32_t number : numbers) {
    const float beyond = coordinates_of(balls[number].centre)[split.axis] - split.position;
    const float reach = safe_reach(balls[number].radius);
    first[in_first] = second[in_second] = number;
    in_first += static_cast<std::size_t>(beyond <= reach);
    in_second += static_cast<std::size_t>(beyond >= -reach);
  }
  const auto visit_first = [&] { visit_leaves_in(first_child(node), balls, std::span(first.data(), in_first), visit); };
  const auto visit_second = [&] {
    visit_leaves_in(second_child(node), balls, std::span(second.data(), in_second), visit);
  };
  if (node.end - node.begin > parallel_size) {
    parallel_invoke(visit_first, visit_second);
  } else {
    visit_first();
    visit_second();
  }
}

}  // namespace lanthorn
