// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "index/bucket_kdtree.h"

#include "base/parallel.h"

namespace lanthorn {

void BucketKdTree::build_node(const Node& node, NumberedPoint* points, SplitRule rule,
                              std::vector<std::uint32_t>& order) {
  if (is_leaf(node)) {
    for (std::uint32_t slot = node.begin; slot < node.end; ++slot) {
      points_.set(slot, point_of(points[slot].position));
      order[slot] = points[slot].number;
    }
    return;
  }
  const std::span<NumberedPoint> own(points + node.begin, node.end - node.begin);
  const Node first = first_child(node), second = second_child(node);
  const unsigned axis = split_axis(own, rule);
  split_at(own, first.end - first.begin, axis);
  splits_[node.number] = {points[second.begin].position[axis], axis};
  const auto build_first = [&] { build_node(first, points, rule, order); };
  const auto build_second = [&] { build_node(second, points, rule, order); };
  if (own.size() > parallel_size) {
    parallel_invoke(build_first, build_second);
  } else {
    build_first();
    build_second();
  }
}

IndexBuild<BucketKdTree> BucketKdTree::build(std::span<const Point> points, SplitRule rule) {
  IndexBuild<BucketKdTree> built;
  BucketKdTree& tree = built.index;
  while (std::size_t{tree.leaves_} * leaf_size < points.size()) tree.leaves_ *= 2;
  tree.splits_ = std::make_unique_for_overwrite<Split[]>(tree.leaves_);
  tree.points_ = SlotPoints(points.size());
  built.order.resize(points.size());
  const auto all = numbered(points);
  tree.build_node(tree.root(), all.get(), rule, built.order);
  return built;
}

template <class Candidates>
std::span<const Neighbour> BucketKdTree::search(const Point& p, Candidates&& candidates) const {
  /// A node to visit later. `offset`: from its region to p along each axis; `dist2`: squared length of `offset` (Arya &
  /// Mount 1993).
  struct Pending {
    Node node;
    Coordinates offset;
    float dist2;
  };
  std::array<Pending, max_depth> pending;
  std::size_t waiting = 0;
  Pending at{root(), {}, 0};
  const Coordinates query = coordinates_of(p);
  for (;;) {
    while (!is_leaf(at.node)) {
      const Split& split = splits_[at.node.number];
      const float beyond = query[split.axis] - split.position;
      const Node first = first_child(at.node), second = second_child(at.node);
      Pending& far = pending[waiting];
      far = {beyond < 0 ? second : first, at.offset, 0};
      far.offset[split.axis] = beyond;
      far.dist2 = sqr(far.offset[0]) + sqr(far.offset[1]) + sqr(far.offset[2]);
      waiting += static_cast<std::size_t>(!candidates.rejects(far.dist2));
      at.node = beyond < 0 ? first : second;
    }
    candidates.offer(points_, SlotRange{at.node.begin, at.node.end}, p);
    do {
      if (waiting == 0) return candidates.found();
      at = pending[--waiting];
    } while (candidates.rejects(at.dist2));
  }
}

std::span<const Neighbour> BucketKdTree::nearest(const Point& p, float max_radius, std::span<Neighbour> memory) const {
  if (memory.empty() || size() == 0) return {};
  if (memory.size() <= NearestSelection::max_count) return search(p, NearestSelection(memory, max_radius));
  return search(p, NearestHeap(memory, max_radius));
}

SlotRange BucketKdTree::leaf_around(const Point& p) const {
  const Coordinates query = coordinates_of(p);
  Node node = root();
  while (!is_leaf(node)) {
    const Split& split = splits_[node.number];
    node = query[split.axis] < split.position ? first_child(node) : second_child(node);
  }
  return {node.begin, node.end};
}

}  // namespace lanthorn
