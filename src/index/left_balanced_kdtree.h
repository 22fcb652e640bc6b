// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The photon map's classic index: Jensen, "Realistic Image Synthesis Using Photon Mapping" (2001), ch. 6.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "index/kd_split.h"
#include "index/nearest_heap.h"
#include "index/point_index.h"
#include "index/slot_points.h"
#include "math/vec.h"

namespace lanthorn {

/// A left-balanced kd-tree with one point per node and no pointers. Slots are nodes in heap order: the children of slot
/// i are 2i + 1 and 2i + 2.
class LeftBalancedKdTree {
 public:
  /// Points must be finite, fewer than 2^31.
  static IndexBuild<LeftBalancedKdTree> build(std::span<const Point> points,
                                              SplitRule rule = SplitRule::largest_extent);

  /// See `PointIndex`.
  template <class Visit>
  void for_each_near(const Point& p, float radius, Visit&& visit) const;

  /// See `NearestIndex`.
  std::span<const Neighbour> nearest(const Point& p, float max_radius, std::span<Neighbour> heap) const;

  std::size_t size() const { return size_; }
  Point position(std::uint32_t slot) const { return point_of(nodes_[slot]); }
  /// Positions and split axes, bytes.
  std::size_t memory_bytes() const { return size_ * (sizeof(Point) + sizeof(std::uint8_t)); }

 private:
  static constexpr std::size_t max_depth = 32;

  void build_node(std::uint32_t slot, std::span<NumberedPoint> points, SplitRule rule,
                  std::vector<std::uint32_t>& order);

  std::size_t size_ = 0;
  std::unique_ptr<Coordinates[]> nodes_;
  std::unique_ptr<std::uint8_t[]> axes_;
};

template <class Visit>
void LeftBalancedKdTree::for_each_near(const Point& p, float radius, Visit&& visit) const {
  const float reach = safe_reach(radius), limit = radius * radius;
  const Coordinates low = coordinates_of(p - Vec3(reach)), high = coordinates_of(p + Vec3(reach));
  std::array<std::uint32_t, max_depth> pending;
  std::size_t waiting = 0;
  std::uint32_t slot = 0;
  for (;;) {
    while (slot < size_) {
      const Coordinates& node = nodes_[slot];
      const float dist2 = distance_squared(point_of(node), p);
      if (dist2 <= limit) visit(slot, dist2);
      const unsigned axis = axes_[slot];
      const bool first = low[axis] <= node[axis], second = high[axis] >= node[axis];
      pending[waiting] = 2 * slot + 2;
      waiting += static_cast<std::size_t>(first && second);
      slot = 2 * slot + (first ? 1 : 2);
    }
    if (waiting == 0) return;
    slot = pending[--waiting];
  }
}

}  // namespace lanthorn
