// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "index/point_index.h"
#include "math/vec.h"

namespace lanthorn {

/// Enlarged query radius for safe pruning. A point whose squared distance, however rounded, is at most radius² differs
/// from the query by less than this in each coordinate (even if squares underflow).
inline float safe_reach(float radius) { return radius * (1.0f + 0x1p-20f) + 1e-18f; }

/// Consecutive slots.
struct SlotRange {
  std::uint32_t begin, end;
};

/// Positions in slot order as three arrays, so that distance tests of consecutive slots vectorise.
class SlotPoints {
 public:
  /// Number of slots tested together.
  static constexpr std::uint32_t width = 8;

  SlotPoints() = default;
  explicit SlotPoints(std::size_t count)
      : size_(count),
        stride_(count + width),  // tests of the last slots read past the end
        coordinates_(std::make_unique_for_overwrite<float[]>(3 * stride_)) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = count; i < stride_; ++i) coordinates_[axis * stride_ + i] = 0;
  }

  std::size_t size() const { return size_; }
  std::size_t memory_bytes() const { return 3 * stride_ * sizeof(float); }
  Point operator[](std::size_t slot) const { return {x()[slot], y()[slot], z()[slot]}; }
  void set(std::size_t slot, const Point& p) {
    coordinates_[slot] = p.x;
    coordinates_[stride_ + slot] = p.y;
    coordinates_[2 * stride_ + slot] = p.z;
  }

  /// Tests at most the first `width` slots of [first, end); writes those with dist2 <= limit to `to`, in ascending
  /// order, and returns their number. `to` must always have room for `width`. Branchless: mispredicted branches would
  /// dominate queries of few points.
  std::uint32_t write_near(std::uint32_t first, std::uint32_t end, const Point& q, float limit, Neighbour* to) const {
#ifdef __AVX2__
    const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(x() + first), _mm256_set1_ps(q.x));
    const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(y() + first), _mm256_set1_ps(q.y));
    const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(z() + first), _mm256_set1_ps(q.z));
    const __m256 dist2 =
        _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
    const auto near =
        static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(dist2, _mm256_set1_ps(limit), _CMP_LE_OQ)));
    const std::uint32_t mask = near & ((1u << std::min(end - first, width)) - 1);
    const __m256i lanes = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(set_lanes[mask])));
    const __m256 distances = _mm256_permutevar8x32_ps(dist2, lanes);
    const __m256 slots = _mm256_castsi256_ps(_mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(first))));
    const __m256 even = _mm256_unpacklo_ps(distances, slots), odd = _mm256_unpackhi_ps(distances, slots);
    _mm256_storeu_ps(&to[0].dist2, _mm256_permute2f128_ps(even, odd, 0x20));
    _mm256_storeu_ps(&to[4].dist2, _mm256_permute2f128_ps(even, odd, 0x31));
    return static_cast<std::uint32_t>(std::popcount(mask));
#else
    std::uint32_t count = 0;
    for (std::uint32_t slot = first; slot < std::min(end, first + width); ++slot) {
      to[count] = {distance_squared((*this)[slot], q), slot};
      count += static_cast<std::uint32_t>(to[count].dist2 <= limit);
    }
    return count;
#endif
  }

  /// Calls `visit(slot, dist2)` for the slots in `ranges` with dist2 <= limit, in order. No range may be empty.
  template <class Visit>
  void for_each_near(std::span<const SlotRange> ranges, const Point& q, float limit, Visit&& visit) const {
    std::uint32_t steps = 0;
    for (const SlotRange& r : ranges) steps += (r.end - r.begin + width - 1) / width;
    if (steps == 0) return;
    std::array<Neighbour, 8 * width> hits;
    std::uint32_t count = 0;
    const SlotRange* range = ranges.data();
    std::uint32_t first = range->begin;
    for (;;) {
      count += write_near(first, range->end, q, limit, hits.data() + count);
      const bool last_step = --steps == 0;
      if (last_step || count > hits.size() - width) {
        for (std::uint32_t i = 0; i < count; ++i) visit(hits[i].slot, hits[i].dist2);
        if (last_step) return;
        count = 0;
      }
      const bool range_done = range->end - first <= width;
      range += range_done;
      first = range_done ? range->begin : first + width;
    }
  }

 private:
  const float* x() const { return coordinates_.get(); }
  const float* y() const { return coordinates_.get() + stride_; }
  const float* z() const { return coordinates_.get() + 2 * stride_; }

  /// Entry m: the positions of the set bits of m, ascending, one per byte from the lowest.
  static constexpr std::array<std::uint64_t, 256> set_lanes = [] {
    std::array<std::uint64_t, 256> table{};
    for (unsigned mask = 0; mask < 256; ++mask) {
      int n = 0;
      for (unsigned bit = 0; bit < 8; ++bit)
        if (mask >> bit & 1) table[mask] |= std::uint64_t{bit} << (8 * n++);
    }
    return table;
  }();

  std::size_t size_ = 0;
  std::size_t stride_ = 0;
  std::unique_ptr<float[]> coordinates_;
};

}  // namespace lanthorn
