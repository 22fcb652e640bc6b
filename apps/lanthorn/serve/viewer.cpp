// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <glm/geometric.hpp>
#include <new>
#include <utility>

#include "../render_arguments.h"
#include "lanthorn/error.h"

namespace lanthorn::program {

namespace {

using namespace std::chrono_literals;

constexpr double first_coarse_pixels = 96 * 96, fewest_coarse_pixels = 48 * 48;
constexpr double coarse_seconds = 0.06;  // of a coarse pass: more than ten a second while the camera moves
constexpr double patient_seconds = 1.5;  // longer full passes have pictures between the coarse one and theirs
constexpr double largest_growth = 6;     // of the pixels from one of those pictures to the next
constexpr double fewest_coarse_photons = 8000;
constexpr std::chrono::milliseconds moving_time = 400ms, watched_time = 30s, frame_patience = 10s,
                                    frame_interval = 40ms;
constexpr int frame_share = 8;  // making frames takes this part of the time at most

double seconds(std::chrono::steady_clock::duration time) { return std::chrono::duration<double>(time).count(); }

// The point that a camera turns around: what is seen in the middle of the picture, else the middle of the scene.
float distance_to_middle(const Image& image, const Scene& scene, const Point& eye) {
  const auto depth = image.find_channel("depth.Z");
  const float seen = depth ? image.at(image.width / 2, image.height / 2, *depth) : 0;
  if (seen > 0 && std::isfinite(seen)) return seen;
  const Bounds bounds = summarize(scene).bounds;
  const float distance = bounds.empty() ? 0 : glm::length(bounds.centre() - eye);
  return distance > 0 && std::isfinite(distance) ? distance : 1;
}

nlohmann::json to_json(const LookAt& look, bool is_mirrored) {
  const auto vector = [](const Vec3& v) { return nlohmann::json{v.x, v.y, v.z}; };
  return {
      {"eye", vector(look.eye)}, {"target", vector(look.target)}, {"up", vector(look.up)}, {"mirrored", is_mirrored}};
}

}  // namespace

Viewer::Viewer(const SharedScene& scene, ViewerSettings settings)
    : scene_(scene),
      settings_(std::move(settings)),
      session_(scene_of(settings_.changes), view_of(*scene_, settings_.changes, settings_.options), settings_.options),
      warnings_(session_.warnings()),
      lights_(lights_of(description_of(*scene))),
      coarse_pixels_(first_coarse_pixels) {
  const StateSummary summary = summarize(session_.state());
  full_pixels_ = static_cast<double>(summary.width) * summary.height;
  aspect_ = static_cast<double>(summary.width) / summary.height;
  is_mirrored_ = description_of(*scene).view.camera.camera_to_world.start.swaps_handedness();
  full_photons_ = nlohmann::json::parse(summary.settings)["identity"]["photons"].get<double>();
  wanted_ = {settings_.changes, 1};
  full_revision_ = 1;
  session_lights_ = settings_.changes.lights;
  watched_until_ = Clock::now() + watched_time;
}

RenderOptions Viewer::coarse_options(double pixels) const {
  RenderOptions options = settings_.options;
  const std::array<int, 2> full = film_size(description_of(*scene_).view, options);
  const double share = std::sqrt(std::min(1.0, pixels / full_pixels_));
  const auto scaled = [share](int x) { return static_cast<int>(std::lround(share * x)); };
  options.resolution = {std::max(1, scaled(full[0])), std::max(1, scaled(full[1]))};
  if (options.crop) {
    const auto& [x0, y0, x1, y1] = *options.crop;
    const auto& [width, height] = *options.resolution;
    const int left = std::min(scaled(x0), width - 1), top = std::min(scaled(y0), height - 1);
    options.crop = {left, top, std::clamp(scaled(x1), left + 1, width), std::clamp(scaled(y1), top + 1, height)};
  }
  const double photons = std::max(fewest_coarse_photons, full_photons_ * share * share);
  options.photons = static_cast<std::uint64_t>(std::min(photons, std::max(1.0, full_photons_)));
  options.pass_range.reset();
  return options;
}

void Viewer::run() {
  Lock lock(mutex_);
  while (true) {
    const Wanted wanted = wanted_;
    const Step step = next_step();
    if (step == Step::end) return;
    if (step == Step::wait) {
      edited_.wait_for(lock, 100ms);
      continue;
    }
    drop_ = has_ended_.load();
    rest_ = is_paused_;
    lock.unlock();
    try {
      step == Step::coarse ? render_coarse(wanted) : refine(wanted);
    } catch (const Error& problem) {
      fail(wanted, problem.what());
    } catch (const std::bad_alloc&) {
      fail(wanted, "not enough memory for this picture");
    }
    lock.lock();
  }
}

Viewer::Step Viewer::next_step() const {
  if (has_ended_) return Step::end;
  if (wanted_.revision == failed_revision_) return Step::wait;
  if (coarse_revision_ != wanted_.revision) return Step::coarse;
  const bool rests = is_paused_ || is_finished_ || Clock::now() < moving_until_ || !is_watched();
  return rests ? Step::wait : Step::refine;
}

void Viewer::end() {
  const std::lock_guard lock(mutex_);
  has_ended_ = drop_ = true;
  edited_.notify_all();
  framed_.notify_all();
}

const Session* Viewer::session() const {
  const std::lock_guard lock(mutex_);
  return full_revision_ == wanted_.revision && session_.pass_count() > 0 ? &session_ : nullptr;
}

bool Viewer::is_wanted(const Wanted& wanted) const {
  const std::lock_guard lock(mutex_);
  return !has_ended_ && wanted.revision == wanted_.revision;
}

// Coarse pictures, each finer than the one before, until the full one will not be long in coming.
void Viewer::render_coarse(const Wanted& wanted) {
  const double taken = render_coarse(wanted, coarse_pixels_);
  // At a few pixels all else counts more than these: then this many are a cautious guess.
  const double growth = std::clamp(coarse_seconds / std::max(taken, 1e-4), 0.25, 2.0);
  double pixels = std::min(coarse_pixels_, full_pixels_);
  coarse_pixels_ = std::clamp(pixels * growth, std::min(fewest_coarse_pixels, full_pixels_), full_pixels_);
  {
    const std::lock_guard lock(mutex_);
    coarse_revision_ = wanted.revision;
    if (Clock::now() < moving_until_ || is_paused_) return;
  }
  for (double rate = taken / pixels; rate * full_pixels_ > patient_seconds && is_wanted(wanted);) {
    pixels *= largest_growth;
    if (2 * pixels > full_pixels_) return;
    rate = render_coarse(wanted, pixels) / pixels;
  }
}

// Returns the seconds that it took.
double Viewer::render_coarse(const Wanted& wanted, double pixels) {
  const Clock::time_point start = Clock::now();
  const RenderOptions options = coarse_options(pixels);
  Session session(scene_of(wanted.changes), view_of(*scene_, wanted.changes, options), options);
  // The first picture of a camera is worth waiting for; those after it are not.
  const bool is_first = pixels <= coarse_pixels_;
  const RenderStatistics statistics =
      session.render({.passes = {0, 1}, .drop = is_first ? &has_ended_ : &drop_, .undo = Undo::never});
  if (session.pass_count() > 0) show(wanted, session.state(), statistics, true);
  return seconds(Clock::now() - start);
}

void Viewer::refine(const Wanted& wanted) {
  if (full_revision_ != wanted.revision) {
    if (const LightFactors& lights = wanted.changes.lights; lights != session_lights_) {
      session_.set_scene(scene_of(wanted.changes));
      session_lights_ = lights;
    }
    session_.set_view(view_of(*scene_, wanted.changes, settings_.options));
    const std::lock_guard lock(mutex_);
    full_revision_ = wanted.revision;
  }
  StopRule stop = session_.plan();
  const RenderOptions& options = settings_.options;
  if (!options.passes && !options.seconds) stop.passes = {0, most_passes};
  if (stop.seconds) *stop.seconds = std::max(0.0, *stop.seconds - summarize(session_.state()).seconds);
  stop.interrupted = &rest_;
  stop.drop = &drop_;
  stop.undo = settings_.keeps_sums ? Undo::always : Undo::never;
  Observer observer;
  observer.progress = [&](const RenderState& state, const RenderStatistics& statistics) {
    const Clock::time_point now = Clock::now();
    if (const std::lock_guard lock(mutex_); !is_watched()) rest_ = true;
    if (now < next_frame_ && !rest_) return;
    show(wanted, state, statistics, false);
    next_frame_ = Clock::now() + std::max<Clock::duration>(frame_interval, frame_share * (Clock::now() - now));
  };
  const RenderStatistics statistics = session_.render(stop, observer);
  if (statistics.out_of_memory) throw std::bad_alloc();
  const bool is_over = !drop_ && !rest_;
  {
    const std::lock_guard lock(mutex_);
    is_finished_ = is_over && wanted.revision == wanted_.revision;
  }
  if (is_over) show(wanted, session_.state(), statistics, false);
}

void Viewer::fail(const Wanted& wanted, const std::string& problem) {
  {
    const std::lock_guard lock(mutex_);
    failed_revision_ = wanted.revision;
    problem_ = problem;
  }
  show_status();
}

void Viewer::apply(const ViewerEdit& edit) {
  if (edit.look) check(*edit.look);
  if (edit.lights) scene_of({.lights = *edit.lights});
  {
    const std::lock_guard lock(mutex_);
    SceneChanges changes = edit.home ? settings_.changes : wanted_.changes;
    if (edit.look) changes.look = edit.look;
    if (edit.lights) changes.lights = *edit.lights;
    if (changes.look != wanted_.changes.look || changes.lights != wanted_.changes.lights) {
      wanted_ = {std::move(changes), wanted_.revision + 1};
      is_finished_ = false;
      problem_.clear();
      drop_ = true;
    }
    if (edit.paused) rest_ = is_paused_ = *edit.paused;
    moving_until_ = edit.moving ? Clock::now() + moving_time : Clock::time_point();
    watched_until_ = Clock::now() + watched_time;
    edited_.notify_all();
  }
  if (edit.paused) show_status();
}

std::shared_ptr<const PageFrame> Viewer::last_frame() const {
  const std::lock_guard lock(mutex_);
  return frame_;
}

std::shared_ptr<const PageFrame> Viewer::wait_for_frame(std::uint64_t after, const IsGone& is_gone) {
  Lock lock(mutex_);
  watched_until_ = Clock::now() + watched_time;
  edited_.notify_all();
  const auto is_there = [&] { return frame_ && frame_->number() != after; };
  const Clock::time_point deadline = Clock::now() + frame_patience;
  while (!is_there() && !has_ended_ && Clock::now() < deadline && !is_gone()) framed_.wait_for(lock, 200ms);
  return is_there() ? frame_ : nullptr;
}

nlohmann::json Viewer::status() const {
  return {{"paused", is_paused_},
          {"finished", is_finished_},
          {"problem", problem_},
          {"has_home", !wanted_.changes.look && wanted_.changes.lights.empty()}};
}

void Viewer::show(const Wanted& wanted, const RenderState& state, const RenderStatistics& statistics, bool is_coarse) {
  auto image = std::make_shared<const Image>(picture_of(state));
  const StateSummary summary = summarize(state);
  nlohmann::json metadata = nlohmann::json::parse(summary.settings)["identity"];
  metadata["passes"] = summary.pass_count;
  const std::lock_guard lock(mutex_);
  if (!has_home_) {
    const ViewDescription home = view_of(*scene_, moved(settings_.changes, {}, {}), settings_.options);
    const LookAt here = look_of(home, settings_.options, 1);
    home_ = look_of(home, settings_.options, distance_to_middle(*image, *scene_, here.eye));
    has_home_ = true;
  }
  nlohmann::json lights = nlohmann::json::object();
  for (const auto& [name, factor] : wanted.changes.lights) lights[name] = factor;
  progress_ = {{"coarse", is_coarse},
               {"passes", summary.pass_count},
               {"seconds", summary.seconds},
               {"samples", static_cast<double>(summary.pass_count) * summary.width * summary.height},
               {"photons", summary.pass_count * metadata["photons"].get<std::uint64_t>()},
               {"traces_photons", statistics.light_paths > 0},
               {"radius", statistics.radius},
               {"volume_radius", statistics.volume_radius},
               {"integrator", summary.integrator},
               {"command", settings_.command(wanted.changes, summary.pass_count)},
               {"aspect", aspect_},
               {"camera", to_json(wanted.changes.look.value_or(home_), is_mirrored_)},
               {"moved", wanted.changes.look.has_value()},
               {"lights", lights}};
  nlohmann::json about = progress_;
  about.update(status());
  frame_ = std::make_shared<const PageFrame>(frame_ ? frame_->number() + 1 : 1, std::move(image), std::move(about),
                                             metadata.dump());
  framed_.notify_all();
}

void Viewer::show_status() {
  const std::lock_guard lock(mutex_);
  if (!frame_) return;
  nlohmann::json about = progress_;
  about.update(status());
  frame_ =
      std::make_shared<const PageFrame>(frame_->number() + 1, frame_->image(), std::move(about), frame_->metadata());
  framed_.notify_all();
}

}  // namespace lanthorn::program
