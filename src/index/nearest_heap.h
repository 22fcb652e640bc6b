// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "index/point_index.h"
#include "index/select_rank.h"
#include "index/slot_points.h"

namespace lanthorn {

/// The nearest points offered so far, in the caller's memory; a max-heap on dist2 once that memory is full.
class NearestHeap {
 public:
  NearestHeap(std::span<Neighbour> memory, float max_radius)
      : memory_(memory), limit_(memory.empty() ? -1 : max_radius * max_radius) {}

  /// Points at a larger squared distance need not be offered.
  float limit() const { return limit_; }
  /// True if every point of a region at this squared distance would be rejected, however distances are rounded.
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

  /// Offers the points of a non-empty range of slots.
  void offer(const SlotPoints& points, SlotRange range, const Point& p) {
    points.for_each_near(std::span(&range, 1), p, limit_,
                         [this](std::uint32_t slot, float dist2) { offer(dist2, slot); });
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

/// Like NearestHeap, for up to `max_count` points and with less work. Candidates are collected in a small array. When
/// it is full, candidates beyond a distance that keeps about the wanted number are dropped.
class NearestSelection {
 public:
  static constexpr std::size_t max_count = 128;

  NearestSelection(std::span<Neighbour> memory, float max_radius) : memory_(memory), limit_(max_radius * max_radius) {}

  bool rejects(float region_dist2) const { return region_dist2 > limit_ * (1 + 0x1p-20f) + 1e-36f; }

  void offer(const SlotPoints& points, SlotRange range, const Point& p) {
    for (std::uint32_t first = range.begin; first < range.end; first += SlotPoints::width) {
      count_ += points.write_near(first, range.end, p, limit_, candidates_.data() + count_);
      if (count_ > candidates_.size() - SlotPoints::width) drop_farther();
    }
    if (count_ >= memory_.size() + slack) drop_farther();
  }

  std::span<const Neighbour> found() {
    const std::span all = candidates().first(count_);
    std::make_heap(all.begin(), all.end());
    for (; count_ > memory_.size(); --count_)
      std::pop_heap(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count_));
    std::copy_n(all.begin(), count_, memory_.begin());
    return memory_.first(count_);
  }

 private:
  /// Candidates are dropped when `slack` more than wanted have accumulated, until at most `spare` more than wanted
  /// remain.
  static constexpr std::size_t slack = 16, spare = 4;

  std::span<Neighbour> candidates() { return std::span(candidates_.data(), count_); }
  std::size_t count_within(float dist2) {
    return static_cast<std::size_t>(std::count_if(candidates().begin(), candidates().end(),
                                                  [dist2](const Neighbour& n) { return n.dist2 <= dist2; }));
  }

  /// Searches for the limit by alternating interpolation and bisection: counting vectorises, selection does not.
  void drop_farther() {
    const std::size_t wanted = memory_.size(), target = wanted + spare / 2;
    float low = 0, high = 0;
    for (const Neighbour& n : candidates()) high = std::max(high, n.dist2);
    std::size_t below = 0, upto = count_;
    for (int step = 0; step < 12 && upto > wanted + spare; ++step) {
      const float part = static_cast<float>(target - below) / static_cast<float>(upto - below);
      const float middle = low + (high - low) * (step % 2 == 0 ? part : 0.5f);
      const std::size_t within = count_within(middle);
      (within < wanted ? low : high) = middle;
      (within < wanted ? below : upto) = within;
    }
    if (upto > wanted + spare) {  // many candidates at about the same distance
      std::nth_element(candidates().begin(), candidates().begin() + static_cast<std::ptrdiff_t>(wanted - 1),
                       candidates().end());
      count_ = wanted;
      limit_ = candidates_[wanted - 1].dist2;
      return;
    }
    std::size_t kept = 0;
    for (const Neighbour n : candidates()) {
      candidates_[kept] = n;
      kept += static_cast<std::size_t>(n.dist2 <= high);
    }
    count_ = kept;
    limit_ = high;
  }

  std::span<Neighbour> memory_;
  float limit_;
  std::size_t count_ = 0;
  std::array<Neighbour, max_count + slack + 64> candidates_;
};

}  // namespace lanthorn
