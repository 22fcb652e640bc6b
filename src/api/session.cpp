// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/session.h"

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "render/picture.h"
#include "render/plan.h"
#include "render/stand_in.h"
#include "render/state.h"
#include "scene/scene.h"

namespace lanthorn {

namespace {

// The film is copied after a pass if the pass took this many times as long as the copy.
constexpr double passes_per_copy = 50;
constexpr double bytes_copied_per_second = 1e9;

}  // namespace

// While passes run, the film belongs to the rendering thread. Other threads see the copy that it publishes between
// passes: after each long pass, and after a short one if another thread waits for it.
struct Session::Impl {
  SharedScene scene;
  ViewDescription view;
  RenderOptions options;
  RenderPlan plan;
  std::atomic<bool> stopped{false};

  std::mutex mutex;  // guards all members below
  std::condition_variable changed;
  bool is_running = false;
  std::uint64_t passes_done = 0;
  bool is_awaited = false;
  struct Published {
    Film film;
    std::vector<PassRange> ranges;
    std::uint64_t passes = 0;
  };
  std::optional<Published> published;
  double pass_seconds = std::numeric_limits<double>::infinity();  // of the last pass; unknown for a resumed render

  Impl(SharedScene scene_, ViewDescription view_, RenderOptions options_)
      : scene(std::move(scene_)),
        view(std::move(view_)),
        options(std::move(options_)),
        plan(plan_render(*scene, view, options)) {}

  void restart(RenderPlan fresh) {
    const std::lock_guard lock(mutex);
    plan = std::move(fresh);
    passes_done = 0;
    published.reset();
  }

  RenderStatistics run(const StopRule& stop, const Observer& observer) {
    begin();
    struct End {
      Impl& impl;
      ~End() { impl.end(); }
    } const ending{*this};
    double before = 0;
    Observer publishing = observer;
    publishing.progress = [&](const RenderState& state, const RenderStatistics& statistics) {
      publish(statistics.seconds - std::exchange(before, statistics.seconds));
      observer.progress(state, statistics);
    };
    return lanthorn::render(*scene, plan, stop, publishing);
  }

  void begin() {
    const std::lock_guard lock(mutex);
    if (passes_done > 0 && copy_is_cheap()) copy_film();
    is_running = true;
  }
  void end() {
    const std::lock_guard lock(mutex);
    passes_done = plan.state.pass_count();
    published.reset();
    is_running = is_awaited = false;
    changed.notify_all();
  }
  bool copy_is_cheap() const {
    return pass_seconds * bytes_copied_per_second > passes_per_copy * static_cast<double>(plan.state.film.memory());
  }
  void publish(double seconds) {
    const std::lock_guard lock(mutex);
    pass_seconds = seconds;
    passes_done = plan.state.pass_count();
    if (!is_awaited && !copy_is_cheap()) return;
    copy_film();
    is_awaited = false;
    changed.notify_all();
  }
  // Copies into the memory of the last copy: faulting in fresh pages would take longer than copying.
  void copy_film() {
    if (!published) {
      published = Published{plan.state.film, plan.state.passes, passes_done};
      return;
    }
    published->film = plan.state.film;
    published->ranges = plan.state.passes;
    published->passes = passes_done;
  }

  Image picture() {
    std::unique_lock lock(mutex);
    if (is_running && !(published && published->passes == passes_done) && passes_done > 0) {
      is_awaited = true;
      changed.wait(lock, [&] { return !is_awaited; });
    }
    if (!is_running) return of(plan.state.film, plan.state.passes, plan.state.pass_count());
    if (!published) throw Error("there is no picture before the end of the first pass");
    return of(published->film, published->ranges, published->passes);
  }
  Image of(const Film& film, const std::vector<PassRange>& ranges, std::uint64_t passes) const {
    if (passes == 0) throw Error("there is no picture before the end of the first pass");
    return measured_picture_of(plan.state, film, ranges).picture;
  }
};

void check_view(const ViewDescription& view, const ViewOptions& options) { make_view(view, options); }
std::array<int, 2> film_size(const ViewDescription& view, const ViewOptions& options) {
  const View made = make_view(view, options);
  return {made.camera.width(), made.camera.height()};
}
Transform camera_placement(const ViewDescription& view, const ViewOptions& options) {
  const View made = make_view(view, options);
  return framing(view.camera, made.camera.width(), made.camera.height()).start;
}

Session::Session(const SharedScene& scene, const RenderOptions& options)
    : Session(scene, description_of(*scene).view, options) {}
Session::Session(SharedScene scene, const ViewDescription& view, const RenderOptions& options)
    : impl_(std::make_unique<Impl>(std::move(scene), view, options)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

const StopRule& Session::plan() const { return impl_->plan.stop; }

std::vector<description::Warning> Session::warnings() const {
  std::vector<description::Warning> all = warnings_of(*impl_->scene, impl_->view);
  if (std::string limitation = impl_->plan.integrator->limitation(*impl_->scene); !limitation.empty())
    all.push_back({{}, std::move(limitation)});
  return all;
}

RenderStatistics Session::render(const StopRule& stop, const Observer& observer) { return impl_->run(stop, observer); }

bool Session::render_pass() {
  const RenderState& state = impl_->plan.state;
  std::uint64_t next = impl_->plan.stop.passes.begin;
  while (state.has_pass(next)) ++next;
  impl_->run({.passes = {next, next + 1}, .drop = &impl_->stopped, .undo = Undo::always}, {});
  const bool is_done = state.has_pass(next);
  if (!is_done) impl_->stopped = false;  // otherwise the stop came too late and applies to the next pass
  return is_done;
}

void Session::stop() { impl_->stopped = true; }

std::uint64_t Session::pass_count() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->passes_done;
}

Image Session::picture() const { return impl_->picture(); }

const RenderState& Session::state() const { return impl_->plan.state; }

void Session::resume(const std::shared_ptr<RenderState>& state, const std::string& name) {
  RenderPlan& plan = impl_->plan;
  remove_stand_in(plan);
  require_same_identity(*state, plan.state.record.identity, name);
  // A file may hold anything.
  const Film &film = state->film, &expected = plan.state.film;
  if (state->integrator != plan.state.integrator || state->shardable != plan.state.shardable ||
      film.width() != expected.width() || film.height() != expected.height() || film.contents() != expected.contents())
    throw Error({name}, "damaged: its film is not that of its settings");
  const std::lock_guard lock(impl_->mutex);
  plan.state = std::move(*state);
  plan.resumed_from = name;
  plan.renew_integrator();
  impl_->passes_done = plan.state.pass_count();
}

void Session::set_scene(SharedScene scene) {
  RenderPlan fresh = plan_render(*scene, impl_->view, impl_->options);
  impl_->scene = std::move(scene);
  impl_->restart(std::move(fresh));
}

void Session::set_view(const ViewDescription& view) {
  RenderPlan fresh = plan_render(*impl_->scene, view, impl_->options);
  impl_->view = view;
  impl_->restart(std::move(fresh));
}

}  // namespace lanthorn
