// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders several passes at once, so that threads that run out of work in one pass continue with another.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "integrators/integrator.h"
#include "lanthorn/session.h"
#include "lanthorn/statistics.h"
#include "render/plan.h"

namespace lanthorn {

/// Decides how many passes to render at once. This affects the time only, not the sums.
class BatchSize {
 public:
  explicit BatchSize(const RenderPlan& plan) : plan_(plan) {}

  /// `seconds`: duration of the last batch, which had `passes` passes.
  void measured(double seconds, std::size_t passes) { seconds_of_pass_ = seconds / static_cast<double>(passes); }
  /// Number of passes in the next batch, at most `most`. `seconds_left`: time until the render must end; none: no
  /// limit.
  std::size_t next(std::uint64_t most, std::optional<double> seconds_left) const;
  /// Duration of a pass of the last batch; 0 before the first.
  double seconds_of_pass() const { return seconds_of_pass_.value_or(0); }

 private:
  const RenderPlan& plan_;
  std::optional<double> seconds_of_pass_;
};

/// Passes that were rendered at once.
struct BatchReport {
  std::vector<PassReport> passes;
  std::array<double, phase_count> phase_seconds{};  ///< of the clock: what passes share is divided among them
};

/// Renders `passes` into the film of the plan, all at once. If a pass throws, the other passes are completed first.
BatchReport render_batch(const RenderJob& job, RenderPlan& plan, const std::vector<std::uint64_t>& passes);

}  // namespace lanthorn
