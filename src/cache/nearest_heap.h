// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/point_index.h"

namespace lanthorn {

/// The nearest points offered so far, in memory of the caller; a max-heap on dist2 as soon as that memory is full.
class NearestHeap {
 public:
  NearestHeap(std::span<Neighbour> memory, float max_radius)
      : memory_(memory), limit_(memory.empty() ? -1 : max_radius * max_radius) {}

  /// Points at a larger squared distance need not be offered.
  float limit() const { return limit_; }
  /// True if no point of a region with this squared distance, rounded however, can be taken.
  bool rejects(float region_dist2) const { return region_dist2 > limit_ * (1 + 0x1p-20f) + 1e-36f; }

  void offer(float dist2, std::uint32_t slot) {
    if (!(dist2 <= limit_)) return;
    if (count_ < memory_.size()) {
      memory_[count_++] = {dist2, slot};
      if (count_ < memory_.size()) return;
      std::make_heap(memory_.begin(), memory_.end());
      limit_ = memory_.front().dist2;
    } else if (dist2 < limit_) {
      replace_farthest({dist2, slot});
      limit_ = memory_.front().dist2;
    }
  }

  /// The found points as a max-heap.
  std::span<const Neighbour> found() {
    const auto all = memory_.first(count_);
    if (count_ < memory_.size()) std::make_heap(all.begin(), all.end());
    return all;
  }

 private:
  void replace_farthest(Neighbour added) {
    const std::size_t count = memory_.size();
    std::size_t hole = 0;
    for (std::size_t child = 1; child < count; child = 2 * hole + 1) {
      if (child + 1 < count) child += static_cast<std::size_t>(memory_[child].dist2 < memory_[child + 1].dist2);
      if (memory_[child].dist2 <= added.dist2) break;
      memory_[hole] = memory_[child];
      hole = child;
    }
    memory_[hole] = added;
  }

  std::span<Neighbour> memory_;
  std::size_t count_ = 0;
  float limit_;
};

}  // namespace lanthorn
