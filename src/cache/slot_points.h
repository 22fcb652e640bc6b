// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "math/vec.h"

namespace lanthorn {

/// Slack on a query radius that makes pruning safe: every point whose squared distance, however it is rounded, comes
/// out
/// <= radius² differs from the query by less than this in each coordinate (also where squares underflow).
inline float safe_reach(float radius) { return radius * (1.0f + 0x1p-20f) + 1e-18f; }

/// Positions in slot order as three arrays, so that distance tests of consecutive slots vectorise.
class SlotPoints {
 public:
  /// Slots tested at a time.
  static constexpr std::uint32_t width = 8;

  SlotPoints() = default;
  explicit SlotPoints(std::size_t count)
      : size_(count),
        stride_(count + width),  // tests of the last slots read past them
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

  /// Squared distances from q to the `width` slots from `first` on, and which of those before `end` are <= limit.
  struct Distances {
    alignas(32) float dist2[width];
    std::uint32_t within;  ///< bit i: slot first + i
  };
  Distances distances(std::uint32_t first, std::uint32_t end, const Point& q, float limit) const {
    Distances d;
    const std::uint32_t in_range = end - first >= width ? 0xffu : (1u << (end - first)) - 1u;
#ifdef __AVX2__
    const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(x() + first), _mm256_set1_ps(q.x));
    const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(y() + first), _mm256_set1_ps(q.y));
    const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(z() + first), _mm256_set1_ps(q.z));
    const __m256 d2 = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
    _mm256_store_ps(d.dist2, d2);
    const int near = _mm256_movemask_ps(_mm256_cmp_ps(d2, _mm256_set1_ps(limit), _CMP_LE_OQ));
    d.within = static_cast<std::uint32_t>(near) & in_range;
#else
    std::uint32_t near = 0;
    for (std::uint32_t i = 0; i < width; ++i) {
      d.dist2[i] = distance_squared((*this)[first + i], q);
      near |= static_cast<std::uint32_t>(d.dist2[i] <= limit) << i;
    }
    d.within = near & in_range;
#endif
    return d;
  }

  /// Calls `visit(slot, dist2)` for the slots of [begin, end) with dist2 <= limit, in ascending order.
  template <class Visit>
  void for_each_within(std::uint32_t begin, std::uint32_t end, const Point& q, float limit, Visit&& visit) const {
    for (std::uint32_t first = begin; first < end; first += width) {
      const Distances d = distances(first, end, q, limit);
      for (std::uint32_t left = d.within; left != 0; left &= left - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
        visit(first + i, d.dist2[i]);
      }
    }
  }

 private:
  const float* x() const { return coordinates_.get(); }
  const float* y() const { return coordinates_.get() + stride_; }
  const float* z() const { return coordinates_.get() + 2 * stride_; }

  std::size_t size_ = 0;
  std::size_t stride_ = 0;
  std::unique_ptr<float[]> coordinates_;
};

}  // namespace lanthorn
