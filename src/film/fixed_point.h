// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The film's integers: steps per unit, limits, and saturating sums.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>

namespace lanthorn {

inline constexpr double unit_steps = 0x1p40;  ///< for colours and vectors of features, and for weights
/// A single contribution is clamped to this.
inline constexpr double contribution_limit = 0x1p56;
/// A sum stops here: far enough below 2^63 that concurrent additions cannot overflow it between two checks.
inline constexpr std::int64_t sum_limit = std::int64_t{1} << 62;

inline void saturating_add(std::int64_t& sum, std::int64_t steps) {
  if (std::abs(sum) >= sum_limit) return;
  sum = std::clamp(sum + steps, -sum_limit, sum_limit);
}

/// Like `saturating_add`, for a sum shared by threads.
inline void saturating_add_shared(std::int64_t& shared, std::int64_t steps) {
  const std::atomic_ref<std::int64_t> sum(shared);
  if (std::abs(sum.load(std::memory_order_relaxed)) >= sum_limit) return;
  const std::int64_t now = sum.fetch_add(steps, std::memory_order_relaxed) + steps;
  if (std::abs(now) >= sum_limit) sum.store(now > 0 ? sum_limit : -sum_limit, std::memory_order_relaxed);
}

}  // namespace lanthorn
