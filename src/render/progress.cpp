// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>

#include "lanthorn/session.h"
#include "render/state.h"

namespace lanthorn {

namespace {

// More passes than any render takes: such a number is no bound.
constexpr std::uint64_t endless = 1u << 31;

std::uint64_t passes_left(const PassRange& asked, const RenderState& state) {
  std::uint64_t left = asked.end - asked.begin;
  for (const PassRange& done : state.passes) {
    const std::uint64_t begin = std::max(asked.begin, done.begin), end = std::min(asked.end, done.end);
    if (begin < end) left -= end - begin;
  }
  return left;
}

// Fraction of the passes that this call needs to reach the bound; below 1 until the bound is reached.
double fraction_of_noise(double bound, const RenderState& state, const RenderStatistics& statistics) {
  if (!statistics.error) return 0;
  if (statistics.error->is_below(bound)) return 1;
  if (!statistics.error->is_known()) return 0;
  const double needed = growth_to_reach(*statistics.error, bound) * static_cast<double>(statistics.error_passes);
  const auto before = static_cast<double>(state.pass_count() + statistics.passes_elsewhere - statistics.passes);
  return std::min(0.99, static_cast<double>(statistics.passes) / std::max(1.0, needed - before));
}

}  // namespace

RenderProgress progress_of(const StopRule& stop, const RenderState& state, const RenderStatistics& statistics) {
  RenderProgress progress;
  const std::uint64_t missing = passes_left(stop.passes, state);
  const std::uint64_t left = missing - std::min(missing, statistics.passes_elsewhere);
  if (left <= endless) {
    progress.passes_left = left;
    const double done = static_cast<double>(statistics.passes), all = done + static_cast<double>(left);
    progress.fraction = all > 0 ? done / all : 1;
  }
  if (stop.seconds) progress.fraction = std::max(progress.fraction, statistics.seconds / *stop.seconds);
  if (stop.noise) progress.fraction = std::max(progress.fraction, fraction_of_noise(*stop.noise, state, statistics));
  progress.fraction = std::min(1.0, progress.fraction);
  if (progress.fraction > 0) progress.seconds_left = statistics.seconds * (1 / progress.fraction - 1);
  return progress;
}

}  // namespace lanthorn
