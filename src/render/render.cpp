// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "integrators/integrator.h"
#include "lanthorn/error.h"
#include "render/pass_batch.h"
#include "render/pass_undo.h"

namespace lanthorn {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

void add(RenderStatistics& sum, const PassReport& pass) {
  ++sum.passes;
  sum.rays += pass.rays;
  sum.light_paths += pass.light_paths;
  sum.photons_stored += pass.photons_stored;
  add_stages(sum.stages, pass.stages);
  add_bounces(sum.photons_per_bounce, pass.photons_per_bounce);
  sum.photon_map_bytes = std::max(sum.photon_map_bytes, pass.photon_map_bytes);
  sum.cache_records += pass.cache_records;
  sum.cache_misses += pass.cache_misses;
  sum.radius = pass.radius;
  sum.volume_radius = pass.volume_radius;
}

void add(RenderStatistics& sum, const BatchReport& batch) {
  for (const PassReport& pass : batch.passes) add(sum, pass);
  for (std::size_t p = 0; p < phase_count; ++p) sum.phase_seconds[p] += batch.phase_seconds[p];
}

bool is_set(const std::atomic<bool>* flag) { return flag && flag->load(); }

bool is_reached(const StopRule& stop, const RenderStatistics& statistics) {
  return stop.noise && statistics.error && statistics.error->is_below(*stop.noise);
}

bool must_stop(const StopRule& stop, const RenderStatistics& statistics) {
  if (is_set(stop.drop) || is_reached(stop, statistics)) return true;
  // At least one pass is rendered, however early the stop: there must be a picture.
  if (statistics.passes == 0) return false;
  return is_set(stop.interrupted) || (stop.seconds && statistics.seconds >= *stop.seconds);
}

// Looks at the picture's error now and then.
class ErrorLooks {
 public:
  ErrorLooks(const StopRule& stop, const Film& film)
      : is_needed_(stop.noise.has_value()), cost_(guessed_per_pixel * film.pixel_count()) {}

  /// The number of passes, of which `passes` are done, until the next look.
  static std::uint64_t passes_until_look(std::uint64_t passes) { return first_look_from(passes + 1) - passes; }

  /// After a batch of passes, `seconds` into the render.
  void look_if_due(const RenderState& state, RenderStatistics& statistics, double seconds) {
    if (first_look_from(state.pass_count()) != state.pass_count()) return;
    if (!is_needed_ && seconds - last_ < cost_ / most_of_time) return;
    const Clock::time_point start = Clock::now();
    statistics.error = estimate_error(state);
    statistics.error_passes = state.pass_count();
    cost_ = seconds_between(start, Clock::now());
    last_ = seconds + cost_;
  }

 private:
  // Each look comes after an eighth more passes than the one before: more would seldom end a render earlier.
  static std::uint64_t first_look_from(std::uint64_t passes) {
    constexpr std::uint64_t first = 4, share = 8;
    std::uint64_t look = first;
    while (look < passes) look += std::max<std::uint64_t>(1, look / share);
    return look;
  }

  static constexpr double guessed_per_pixel = 1e-6, most_of_time = 0.01;

  bool is_needed_;
  double cost_, last_ = 0;  // seconds
};

// Returns false if the pass was stopped before its end.
template <class Work>
bool run_unless_stopped(const std::atomic<bool>* flag, Work&& work) try {
  const StopScope scope(flag);
  work();
  return true;
} catch (const Stopped&) {
  return false;
}

// As above; also returns false if memory ran out and the pass can be undone.
template <class Work>
bool run_pass(const std::atomic<bool>* flag, bool can_undo, bool& out_of_memory, Work&& work) try {
  return run_unless_stopped(flag, work);
} catch (const std::bad_alloc&) {
  if (!can_undo) throw;
  out_of_memory = true;
  return false;
}

// The next `most` passes of the range that the state does not have.
std::vector<std::uint64_t> next_passes(const RenderState& state, const PassRange& range, std::size_t most) {
  std::vector<std::uint64_t> passes;
  for (std::uint64_t pass = range.begin; pass < range.end && passes.size() < most; ++pass)
    if (!state.has_pass(pass)) passes.push_back(pass);
  return passes;
}

// A look at the error must find the passes that it is fixed to, and no others.
std::uint64_t passes_until_stop(const StopRule& stop, const RenderState& state) {
  return stop.noise ? ErrorLooks::passes_until_look(state.pass_count()) : std::numeric_limits<std::uint64_t>::max();
}

std::optional<double> seconds_left(const StopRule& stop, const RenderStatistics& statistics) {
  if (!stop.seconds) return std::nullopt;
  return *stop.seconds - statistics.seconds;
}

void add(RenderState& state, const std::vector<std::uint64_t>& passes, const BatchReport& report) {
  for (std::size_t i = 0; i < passes.size(); ++i) {
    state.add_pass(passes[i]);
    state.eye += report.passes[i].rays.eye;
    state.light += report.passes[i].rays.light;
  }
}

void keep_findings(const Integrator& integrator, RenderState& state) {
  const std::string findings = integrator.findings();
  if (findings.empty()) return;
  nlohmann::json settings = nlohmann::json::parse(state.settings);
  settings["findings"] = nlohmann::json::parse(findings);
  state.settings = settings.dump();
}

void load_integrator_state(RenderPlan& plan) try {
  if (!plan.state.integrator_state.empty()) plan.integrator->load(plan.state.integrator_state);
} catch (const Error& problem) {
  throw Error({plan.resumed_from}, problem.message);
}

}  // namespace

RenderStatistics render(const Scene& scene, RenderPlan& plan, const StopRule& stop, const Observer& observer) {
  const RenderJob job = plan.job(scene);
  RenderState& state = plan.state;
  RenderStatistics statistics;
  const Clock::time_point start = Clock::now();
  const double seconds_before = state.seconds;
  if (!plan.is_prepared) {
    state.film.set_sensor(job.view.sensor);
    state.film.set_window(job.view.window, job.view.camera.width());
    observer.can_drop(stop.drop != nullptr);
    if (!run_unless_stopped(stop.drop, [&] { plan.integrator->prepare(job); })) return statistics;
    load_integrator_state(plan);
    plan.is_prepared = true;
    keep_findings(*plan.integrator, state);
    if (const std::string remark = plan.integrator->remark(); !remark.empty()) observer.remark(remark);
    observer.prepared(state);
  }
  statistics.prepare_seconds = statistics.seconds = seconds_between(start, Clock::now());

  PassUndo undo(stop.undo);
  ErrorLooks looks(stop, state.film);
  if (stop.noise) looks.look_if_due(state, statistics, statistics.seconds);  // of a state that is resumed
  BatchSize batch_size(plan);
  std::optional<double> batch_seconds;
  Clock::time_point last_checkpoint = Clock::now();
  while (!must_stop(stop, statistics)) {
    const std::vector<std::uint64_t> batch = next_passes(
        state, stop.passes, batch_size.next(passes_until_stop(stop, state), seconds_left(stop, statistics)));
    if (batch.empty()) break;
    const bool can_undo = undo.begin(state, batch_seconds), can_drop = stop.drop && can_undo;
    observer.can_drop(can_drop);
    const Clock::time_point batch_start = Clock::now();
    BatchReport report;
    if (!run_pass(can_drop ? stop.drop : nullptr, can_undo && stop.undo != Undo::never, statistics.out_of_memory,
                  [&] { report = render_batch(job, plan, batch); })) {
      undo.restore(state);
      plan.renew_integrator();
      break;
    }
    add(statistics, report);
    add(state, batch, report);
    const Clock::time_point now = Clock::now();
    state.integrator_state = plan.integrator->save();
    batch_seconds = seconds_between(batch_start, now);
    batch_size.measured(*batch_seconds, batch.size());
    statistics.seconds = seconds_between(start, now);
    if (statistics.passes == 1) statistics.first_pass_seconds = statistics.seconds;
    state.seconds = seconds_before + statistics.seconds;
    looks.look_if_due(state, statistics, statistics.seconds);
    if (observer.checkpoint(state, seconds_between(last_checkpoint, now))) last_checkpoint = Clock::now();
    observer.progress(state, statistics);
  }
  return statistics;
}

std::optional<std::string> describe_problems(const FilmReport& report) {
  if (report.clean()) return std::nullopt;
  const std::optional<FilmPlace> place = report.first_non_finite ? report.first_non_finite : report.first_too_large;
  return fmt::format("{} samples were not finite, {} too large for the film, {} sums saturated{}", report.non_finite,
                     report.too_large, report.saturated,
                     place ? fmt::format("; first in pass {}, pixel {}", place->pass, place->pixel) : "");
}

}  // namespace lanthorn
