// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The pass loop: one for all methods.
#include "render/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/parallel.h"
#include "integrators/integrator.h"
#include "lanthorn/error.h"
#include "render/abandoned_pass.h"
#include "render/looks.h"
#include "render/pass_batch.h"
#include "render/stand_in.h"
#include "render/team/member.h"

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

// How late a render may end, s: by a share of its limit, but no less than users notice.
double tolerance(double share, double limit) { return std::max(share * limit, 0.5); }

// `pass_seconds`: expected duration of the next pass.
bool is_over(const StopRule& stop, const RenderStatistics& statistics, double pass_seconds) {
  if (!stop.seconds) return false;
  return statistics.seconds >= *stop.seconds ||
         statistics.seconds + pass_seconds > *stop.seconds + tolerance(0.05, *stop.seconds);
}

// `needs_pass`: at least one pass is rendered, however early the stop, because there must be a picture.
bool must_stop(const StopRule& stop, const RenderStatistics& statistics, bool needs_pass, double pass_seconds) {
  if (is_set(stop.drop) || is_reached(stop, statistics)) return true;
  if (needs_pass && statistics.passes == 0) return false;
  return is_set(stop.interrupted) || is_over(stop, statistics, pass_seconds);
}

// When running passes are abandoned.
std::optional<Clock::time_point> end_of(const StopRule& stop, Clock::time_point start) {
  if (!stop.seconds || stop.team) return {};
  const double seconds = std::min(*stop.seconds + tolerance(0.1, *stop.seconds), 1e9);
  return start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

// A call of `render`.
struct Call {
  const Scene& scene;
  RenderPlan& plan;
  const StopRule& stop;
  const Observer& observer;
  Clock::time_point start;
  bool has_stand_in = false;  ///< the time may end it before its first pass is complete

  RenderJob job() const { return plan.job(scene); }
  double seconds() const { return seconds_between(start, Clock::now()); }
};

// Looks at the picture's error now and then.
class ErrorLooks {
 public:
  ErrorLooks(const StopRule& stop, const Film& film) : stop_(stop), cost_(guessed_per_pixel * film.pixel_count()) {}

  /// After a pass, `seconds` into the render.
  void look_if_due(const RenderState& state, RenderStatistics& statistics, double seconds) {
    const bool is_own = stop_.noise && stop_.error_of;
    if (!is_look(state.pass_count(), is_own)) return;
    if (!stop_.noise && seconds - last_ < cost_ / most_of_time) return;
    const Clock::time_point start = Clock::now();
    statistics.error = is_own ? stop_.error_of(state) : estimate_error(state);
    statistics.error_passes = state.pass_count();
    cost_ = seconds_between(start, Clock::now());
    last_ = seconds + cost_;
  }

 private:
  static constexpr double guessed_per_pixel = 1e-6, most_of_time = 0.01;

  const StopRule& stop_;
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

void load_integrator_state(RenderPlan& plan) try {
  if (!plan.state.integrator_state.empty()) plan.integrator->load(plan.state.integrator_state);
} catch (const Error& problem) {
  throw Error({plan.resumed_from}, problem.message);
}

// False if it was given up.
bool prepare(const Call& call, const RenderJob& job, const std::atomic<bool>* flag) {
  RenderPlan& plan = call.plan;
  const Observer& observer = call.observer;
  if (plan.is_prepared) return true;
  RenderState& state = plan.state;
  state.film.set_sensor(job.view.sensor);
  state.film.set_window(job.view.window, job.view.camera.width());
  observer.can_drop(call.stop.drop != nullptr);
  if (!run_unless_stopped(flag, [&] { plan.integrator->prepare(job); })) return false;
  job.scene.require_textures();
  load_integrator_state(plan);
  plan.is_prepared = true;
  state.record.findings = plan.integrator->findings();
  if (const std::string remark = plan.integrator->remark(); !remark.empty()) observer.remark(remark);
  observer.prepared(state);
  return true;
}

// The next `most` passes of the range that the state does not have.
std::vector<std::uint64_t> next_passes(const RenderState& state, const PassRange& range, std::size_t most) {
  std::vector<std::uint64_t> passes;
  for (std::uint64_t pass = range.begin; pass < range.end && passes.size() < most; ++pass)
    if (!state.has_pass(pass)) passes.push_back(pass);
  return passes;
}

void add(RenderState& state, const std::vector<std::uint64_t>& passes, const BatchReport& report) {
  for (std::size_t i = 0; i < passes.size(); ++i) {
    state.add_pass(passes[i]);
    state.eye += report.passes[i].rays.eye;
    state.light += report.passes[i].rays.light;
  }
}

// Batches of passes, one after the other. In a team, a batch is one pass. The plan's state holds the passes that this
// process has rendered and not yet handed over; rank 0 also holds the sums of all processes.
class PassLoop {
 public:
  /// `deadline`: the flag that is set when the time is over, and soon after `StopRule::drop`.
  PassLoop(const Call& call, const RenderJob& job, RenderStatistics& statistics, const std::atomic<bool>* deadline)
      : plan_(call.plan),
        job_(job),
        stop_(call.stop),
        observer_(call.observer),
        statistics_(statistics),
        start_(call.start),
        deadline_(deadline),
        needs_pass_(!call.has_stand_in && call.plan.state.pass_count() == 0),
        seconds_before_(call.plan.state.seconds),
        undo_(call.stop.undo),
        looks_(call.stop, call.plan.state.film),
        batch_size_(call.plan) {
    if (stop_.noise) looks_.look_if_due(plan_.state, statistics, statistics.seconds);  // of a state that is resumed
    if (stop_.team && stop_.team->link.size > 1) join_team();
  }

  void run() {
    for (auto batch = next(); !batch.empty(); batch = next())
      if (!render(batch)) give_up();
    if (!member_) return;
    member_->finish();
    if (!total_) return;
    add_counts(statistics_, encode_counts(member_->counts_of_others()));
    statistics_.passes = total_->pass_count() - passes_before_;
    statistics_.passes_elsewhere = 0;
    plan_.state = *std::move(total_);
  }

 private:
  void join_team();
  using Batch = std::vector<std::uint64_t>;  // empty: nothing more is to be rendered
  Batch next() { return member_ ? next_of_team() : next_of_own(); }
  Batch next_of_own();
  Batch next_of_team();
  void add_gathered(const RoundSums& sums);
  bool render(const Batch& batch);
  void record(const Batch& batch, const BatchReport& report, Clock::time_point batch_start);
  void show();
  void give_up();
  bool is_discarded() const { return member_ && member_->discard()->load(); }
  const std::atomic<bool>* drop_flag() const {
    return member_ && !member_->is_first() ? member_->give_up() : stop_.drop;
  }
  // The flag for a pass that can be undone. The time must not end the only pass, nor a pass that takes all earlier ones
  // with it.
  const std::atomic<bool>* flag_of_pass() const {
    if (member_) return drop_flag();
    const bool is_only = needs_pass_ && statistics_.passes == 0;
    const bool takes_all = stop_.undo == Undo::never && plan_.state.pass_count() > 0;
    return is_only || takes_all ? stop_.drop : deadline_;
  }

  RenderPlan& plan_;
  const RenderJob& job_;
  const StopRule& stop_;
  const Observer& observer_;
  RenderStatistics& statistics_;
  Clock::time_point start_;
  const std::atomic<bool>* deadline_;
  bool needs_pass_;
  double seconds_before_;
  PassUndo undo_;
  ErrorLooks looks_;
  BatchSize batch_size_;
  bool is_over_ = false;
  std::optional<double> batch_seconds_;
  Clock::time_point last_checkpoint_ = Clock::now();

  std::optional<TeamMember> member_;
  std::optional<RenderState> total_;  // at rank 0: the sums gathered so far
  std::uint64_t passes_before_ = 0;
  RenderStatistics rendered_;  // since the last question
};

void PassLoop::join_team() {
  RenderState& state = plan_.state;
  if (!state.shardable)
    throw Error(
        fmt::format("each pass of {} depends on all before it, so that several processes cannot share them; "
                    "render it with one, or choose another --integrator",
                    state.integrator));
  member_.emplace(*stop_.team, stop_, state, start_);
  passes_before_ = state.pass_count();
  RenderState own = empty_like(state);
  if (member_->is_first()) total_ = std::move(state);
  state = std::move(own);
  seconds_before_ = 0;
  if (member_->is_first() && is_reached(stop_, statistics_)) member_->stop();
}

PassLoop::Batch PassLoop::next_of_own() {
  if (is_over_ || must_stop(stop_, statistics_, needs_pass_, batch_size_.seconds_of_pass())) return {};
  // The error must be looked at after exactly the number of passes that is fixed for the look.
  const std::uint64_t done = plan_.state.pass_count(),
                      most = stop_.noise ? next_look(done).passes - done : std::numeric_limits<std::uint64_t>::max();
  std::optional<double> left;
  if (stop_.seconds) left = *stop_.seconds - statistics_.seconds;
  return next_passes(plan_.state, stop_.passes, batch_size_.next(most, left));
}

PassLoop::Batch PassLoop::next_of_team() {
  for (;;) {
    const TeamMember::Task task = member_->next(plan_.state, rendered_);
    rendered_ = {};
    if (const auto* pass = std::get_if<TeamMember::Pass>(&task)) return {pass->number};
    const auto* gathered = std::get_if<TeamMember::Sums>(&task);
    if (!gathered) return {};
    add_gathered(gathered->sums);
  }
}

void PassLoop::add_gathered(const RoundSums& sums) {
  if (sums) merge_into(*total_, *sums);
  looks_.look_if_due(*total_, statistics_, statistics_.seconds);
  member_->settle(is_reached(stop_, statistics_));
  if (observer_.checkpoint(*total_, seconds_between(last_checkpoint_, Clock::now()))) last_checkpoint_ = Clock::now();
  show();
}

// False if the batch was given up and has left no trace.
bool PassLoop::render(const Batch& batch) {
  RenderState& state = plan_.state;
  state.film.set_sensor(job_.view.sensor);  // of a new film, after the last one was handed over
  state.film.set_window(job_.view.window, job_.view.camera.width());
  const std::atomic<bool>* const drop = drop_flag();
  const bool can_undo = undo_.begin(state, batch_seconds_), can_drop = drop && can_undo;
  observer_.can_drop(can_drop);
  const std::atomic<bool>* const flag = can_undo && flag_of_pass() ? flag_of_pass()
                                        : member_                  ? member_->discard()
                                                                   : nullptr;
  const Clock::time_point batch_start = Clock::now();
  BatchReport report;
  if (!run_pass(flag, can_undo && stop_.undo != Undo::never, statistics_.out_of_memory, [&] {
        report = render_batch(job_, plan_, batch);
        job_.scene.require_textures();
      })) {
    if (is_discarded())
      state = empty_like(state);
    else
      undo_.restore(state);
    plan_.renew_integrator();
    return false;
  }
  record(batch, report, batch_start);
  return true;
}

void PassLoop::record(const Batch& batch, const BatchReport& report, Clock::time_point batch_start) {
  RenderState& state = plan_.state;
  const Clock::time_point now = Clock::now();
  add(statistics_, report);
  if (member_) add(rendered_, report);
  add(state, batch, report);
  state.integrator_state = plan_.integrator->save();
  batch_seconds_ = seconds_between(batch_start, now);
  batch_size_.measured(*batch_seconds_, batch.size());
  statistics_.seconds = seconds_between(start_, now);
  if (statistics_.passes == 1) statistics_.first_pass_seconds = statistics_.seconds;
  if (member_) {
    state.seconds += *batch_seconds_;
    show();
    return;
  }
  state.seconds = seconds_before_ + statistics_.seconds;
  looks_.look_if_due(state, statistics_, statistics_.seconds);
  if (observer_.checkpoint(state, seconds_between(last_checkpoint_, now))) last_checkpoint_ = Clock::now();
  show();
}

void PassLoop::show() {
  if (!member_) return observer_.progress(plan_.state, statistics_);
  if (!total_) return;
  RenderStatistics all = statistics_;
  add_counts(all, encode_counts(member_->counts_of_others()));
  const std::uint64_t gathered = total_->pass_count() - passes_before_;
  all.passes_elsewhere = all.passes - std::min(all.passes, gathered);
  observer_.progress(*total_, all);
}

void PassLoop::give_up() {
  is_over_ = true;
  if (!member_) return;
  if (member_->is_first())
    member_->stop();
  else if (statistics_.out_of_memory)
    throw std::bad_alloc();
}

RenderStatistics render_passes(const Call& call) {
  const RenderJob job = call.job();
  const Deadline deadline(call.stop.drop, end_of(call.stop, call.start));
  RenderStatistics statistics;
  const double before = call.seconds();
  const bool is_prepared = prepare(call, job, call.has_stand_in ? deadline.flag() : call.stop.drop);
  statistics.seconds = call.seconds();
  if (!is_prepared) return statistics;
  statistics.prepare_seconds = statistics.seconds - before;
  PassLoop(call, job, statistics, deadline.flag()).run();
  return statistics;
}

bool needs_stand_in(const RenderPlan& plan, const StopRule& stop) {
  return stop.seconds && !stop.team && plan.coarse && plan.state.pass_count() == 0 &&
         plan.state.film.pixel_count() >= StandIn::fewest_pixels;
}

}  // namespace

RenderStatistics render(const Scene& scene, RenderPlan& plan, const StopRule& stop, const Observer& observer) {
  if (stop.noise) check_error_bound(*stop.noise);
  remove_stand_in(plan);
  Call call{scene, plan, stop, observer, Clock::now()};
  if (!needs_stand_in(plan, stop)) return render_passes(call);

  observer.can_drop(stop.drop != nullptr);
  const Deadline deadline(stop.drop, end_of(stop, call.start));
  StandIn stand_in(scene, plan, [&](RenderPlan& coarse, const StopRule& rule, bool may_be_none) {
    return render_passes({scene, coarse, rule, Observer{}, Clock::now(), may_be_none});
  });
  const auto seconds_left = [&] { return *stop.seconds + tolerance(0.05, *stop.seconds) - call.seconds(); };
  RenderStatistics statistics;
  const bool allows_pass = stand_in.allows_pass(seconds_left, stop.drop, deadline.flag());
  call.has_stand_in = stand_in.has_picture();
  if (allows_pass || !call.has_stand_in)
    statistics = render_passes(call);
  else
    stand_in.refine(*stop.seconds - call.seconds(), stop);
  if (plan.state.pass_count() > 0 || !call.has_stand_in || is_set(stop.drop) || statistics.out_of_memory)
    return statistics;
  statistics.seconds = call.seconds();
  stand_in.put_into(plan, statistics);
  observer.progress(plan.state, statistics);
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
