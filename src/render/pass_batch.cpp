// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/pass_batch.h"

#include <algorithm>
#include <chrono>
#include <exception>

#include "base/parallel.h"
#include "film/film_pass.h"

namespace lanthorn {

namespace {

using Clock = std::chrono::steady_clock;
using PhaseSeconds = std::array<double, phase_count>;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Charges time to the phase of a pass that is running.
class PhaseTimer {
 public:
  explicit PhaseTimer(PhaseSeconds& seconds) : seconds_(seconds) {}
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;
  ~PhaseTimer() { end(); }
  void begin(Phase phase) {
    end();
    phase_ = phase;
    since_ = Clock::now();
  }

 private:
  void end() {
    if (phase_) seconds_[static_cast<std::size_t>(*phase_)] += seconds_since(since_);
  }

  PhaseSeconds& seconds_;
  std::optional<Phase> phase_;
  Clock::time_point since_;
};

PassReport render_parts(const RenderJob& job, std::uint64_t pass, RenderPlan& plan, PhaseSeconds& seconds) {
  const std::uint32_t parts = job.settings.parts;
  const FilmPass film(plan.state.film, pass, 1 / static_cast<float>(parts));
  PhaseTimer timer(seconds);
  PassReport report;
  for (std::uint32_t part = 0; part < parts; ++part) {
    const auto number = static_cast<std::uint32_t>(pass * parts + part);
    report += plan.integrator->render_pass(job, number, film, [&](Phase phase) { timer.begin(phase); });
  }
  return report;
}

// A part of the clock's time `all` for each phase, in proportion to the sums over the passes.
PhaseSeconds divide_time(double all, const std::vector<PhaseSeconds>& of_passes) {
  PhaseSeconds seconds{};
  double sum = 0;
  for (const PhaseSeconds& pass : of_passes)
    for (std::size_t p = 0; p < phase_count; ++p) {
      seconds[p] += pass[p];
      sum += pass[p];
    }
  for (double& phase : seconds) phase *= sum > 0 ? all / sum : 0;
  return seconds;
}

}  // namespace

std::size_t BatchSize::next(std::uint64_t most, std::optional<double> seconds_left) const {
  if (!seconds_of_pass_ || thread_count() < 2 || !plan_.integrator->passes_may_overlap()) return 1;
  // Users wait for the end of a batch. Long passes spend little of their time at the ends of phases.
  constexpr double long_pass = 5;  // s
  if (*seconds_of_pass_ > long_pass) return 1;
  // Two passes hide the end of each other's phases. Short passes need more, so that ends of batches are rare, too.
  constexpr double batch_seconds = 0.2;
  constexpr double fewest = 2, many = 64;
  double wanted = std::clamp(batch_seconds / *seconds_of_pass_, fewest, many);
  if (seconds_left) wanted = std::min(wanted, *seconds_left / *seconds_of_pass_);
  wanted = std::min({wanted, static_cast<double>(most), static_cast<double>(plan_.passes_that_fit)});
  return static_cast<std::size_t>(std::max(wanted, 1.0));
}

BatchReport render_batch(const RenderJob& job, RenderPlan& plan, const std::vector<std::uint64_t>& passes) {
  const Clock::time_point start = Clock::now();
  BatchReport report;
  report.passes.resize(passes.size());
  std::vector<PhaseSeconds> seconds(passes.size());
  // Exceptions wait until all passes have ended: TBB would cut the loops of the other passes short, and they would
  // continue with half of their photons.
  std::vector<std::exception_ptr> thrown(passes.size());
  parallel_for(std::size_t{0}, passes.size(), [&](std::size_t i) {
    try {
      report.passes[i] = render_parts(job, passes[i], plan, seconds[i]);
    } catch (...) {
      thrown[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& problem : thrown)
    if (problem) std::rethrow_exception(problem);
  report.phase_seconds = divide_time(seconds_since(start), seconds);
  return report;
}

}  // namespace lanthorn
