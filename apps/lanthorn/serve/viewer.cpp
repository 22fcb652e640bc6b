// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "../value_types.h"
#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/session.h"

namespace lanthorn::program {

namespace {

using namespace std::chrono_literals;

constexpr std::chrono::milliseconds watched_time = 30s, frame_patience = 10s;

// Distance to the point that the camera orbits: the surface in the middle of the picture, else the scene's centre.
float distance_to_middle(const Image& image, const Scene& scene, const DVec3& eye) {
  const auto depth = image.find_channel("depth.Z");
  const float seen = depth ? image.at(image.width / 2, image.height / 2, *depth) : 0;
  if (seen > 0 && std::isfinite(seen)) return seen;
  const Bounds bounds = summarize(scene).bounds;
  const float distance = bounds.empty() ? 0 : static_cast<float>(glm::length(DVec3(bounds.centre()) - eye));
  return distance > 0 && std::isfinite(distance) ? distance : 1;
}

nlohmann::json to_json(const LookAt& look, bool is_mirrored) {
  const auto vector = [](const DVec3& v) { return nlohmann::json{v.x, v.y, v.z}; };
  return {
      {"eye", vector(look.eye)}, {"target", vector(look.target)}, {"up", vector(look.up)}, {"mirrored", is_mirrored}};
}

// Without passes and time, a view refines until it changes.
RenderOptions endless(RenderOptions options) {
  if (!options.passes && !options.seconds && !options.noise) options.passes = most_passes;
  return options;
}

}  // namespace

Viewer::Viewer(const SharedScene& scene, ViewerSettings settings)
    : scene_(scene),
      settings_(std::move(settings)),
      lights_(lights_of(*scene)),
      is_mirrored_(description_of(*scene).view.camera.camera_to_world.start.swaps_handedness()),
      render_(scale_lights(scene_, settings_.start.changes.lights),
              view_of(*scene_, settings_.start.changes, settings_.start.options), endless(settings_.start.options),
              {.keeps_sums = settings_.keeps_sums}),
      wanted_(settings_.start),
      scenes_{{render_.snapshot().status.revision, wanted_}},
      watched_until_(Clock::now() + watched_time) {}

void Viewer::tend() {
  const std::lock_guard lock(mutex_);
  const InteractiveSnapshot now = render_.snapshot();
  const bool is_refused = now.status.phase == InteractivePhase::failed && now.picture &&
                          now.picture->revision != now.status.revision && scenes_.contains(now.picture->revision);
  if (is_refused) {
    problem_ = now.status.problem;
    submit(scenes_.at(now.picture->revision), /*is_moving=*/false);
  }
  render_.pause(is_paused_ || !is_watched());
}

void Viewer::end() {
  {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
  }
  render_.stop();
}

void Viewer::look() {
  watched_until_ = Clock::now() + watched_time;
  render_.pause(is_paused_);
}

RenderOptions Viewer::edited_options(const ViewerEdit& edit) const {
  const RenderOptions& start = settings_.start.options;
  RenderOptions options = wanted_.options;
  if (edit.method) {
    options.integrator = find_method(*edit.method).name;
    options.set = *edit.method == start.integrator.value_or(first_method_) ? start.set : decltype(options.set)();
  }
  if (edit.size) {
    if (options.crop) throw Error("the size cannot be changed with --crop, which is in pixels");
    options.resolution = edit.size;
  }
  return options;
}

std::uint64_t Viewer::apply(const ViewerEdit& edit) {
  if (edit.look) check(*edit.look);
  const std::lock_guard lock(mutex_);
  ViewerScene next{edit.home ? settings_.start.changes : wanted_.changes, edited_options(edit)};
  if (edit.look) next.changes.look = edit.look;
  if (edit.lights) next.changes.lights = *edit.lights;
  if (edit.size) check_view(view_of(*scene_, next.changes, next.options), next.options);
  const std::uint64_t revision = submit(std::move(next), edit.moving);
  problem_.clear();
  if (edit.paused) is_paused_ = *edit.paused;
  look();
  return revision;
}

std::uint64_t Viewer::submit(ViewerScene next, bool is_moving) {
  RenderEdit edit{.is_moving = is_moving};
  if (next.changes.look != wanted_.changes.look) edit.view = view_of(*scene_, next.changes, next.options);
  if (next.changes.lights != wanted_.changes.lights)
    edit.scene = [scene = scale_lights(scene_, next.changes.lights)] { return scene; };
  const RenderOptions &before = wanted_.options, &now = next.options;
  if (now.integrator != before.integrator || now.set != before.set || now.resolution != before.resolution)
    edit.options = endless(now);
  wanted_ = std::move(next);
  const std::uint64_t revision = render_.edit(std::move(edit));
  scenes_[revision] = wanted_;
  return revision;
}

std::shared_ptr<const PageFrame> Viewer::last_frame() { return frame_of(render_.snapshot()); }

std::shared_ptr<const PageFrame> Viewer::wait_for_frame(std::uint64_t after, const IsGone& is_gone) {
  const auto has_ended = [&] {
    const std::lock_guard lock(mutex_);
    look();
    return has_ended_;
  };
  const Clock::time_point deadline = Clock::now() + frame_patience;
  std::uint64_t seen = after;
  while (!has_ended()) {
    const InteractiveSnapshot snapshot = render_.wait(seen, 200ms);
    if (snapshot.picture && snapshot.number != after) return frame_of(snapshot);
    if (Clock::now() > deadline || is_gone()) break;
    seen = snapshot.number;
  }
  return nullptr;
}

// Each snapshot becomes one frame, however many pages ask for it.
std::shared_ptr<const PageFrame> Viewer::frame_of(const InteractiveSnapshot& snapshot) {
  const std::lock_guard lock(mutex_);
  if (!snapshot.picture || (frame_ && frame_->number() >= snapshot.number)) return frame_;
  if (first_method_.empty()) first_method_ = snapshot.picture->state.integrator;
  nlohmann::json metadata = nlohmann::json::parse(snapshot.picture->state.settings)["identity"];
  metadata["passes"] = snapshot.picture->state.pass_count;
  frame_ = std::make_shared<const PageFrame>(snapshot.number,
                                             std::shared_ptr<const Image>(snapshot.picture, &snapshot.picture->image),
                                             about(snapshot), metadata.dump());
  scenes_.erase(scenes_.begin(), scenes_.lower_bound(snapshot.picture->revision));
  return frame_;
}

const LookAt& Viewer::home(const Image& image) {
  if (!home_) {
    const RenderOptions& options = settings_.start.options;
    const ViewDescription own = view_of(*scene_, moved(settings_.start.changes, {}, {}), options);
    const DVec3& origin = description_of(*scene_).origin;
    const DVec3 eye = look_of(own, options, 1, origin).eye;
    home_ = look_of(own, options, distance_to_middle(image, *scene_, eye), origin);
  }
  return *home_;
}

nlohmann::json Viewer::about(const InteractiveSnapshot& snapshot) {
  using enum InteractivePhase;
  const InteractivePicture& picture = *snapshot.picture;
  const StateSummary& state = picture.state;
  const ViewerScene& scene = scenes_.at(picture.revision);
  const SceneChanges& changes = scene.changes;
  const auto photons = nlohmann::json::parse(state.settings)["identity"]["photons"].get<std::uint64_t>();
  const InteractivePhase phase = snapshot.status.phase;
  nlohmann::json lights = nlohmann::json::object();
  for (const auto& [name, factor] : changes.lights) lights[name] = factor;
  return {{"revision", picture.revision},
          {"coarse", picture.is_coarse},
          {"passes", state.pass_count},
          {"seconds", state.seconds},
          {"samples", static_cast<double>(state.pass_count) * state.width * state.height},
          {"photons", state.pass_count * photons},
          {"traces_photons", picture.statistics.light_paths > 0},
          {"error", picture.statistics.error ? describe_error(*picture.statistics.error) : ""},
          {"radius", picture.statistics.radius},
          {"volume_radius", picture.statistics.volume_radius},
          {"integrator", state.integrator},
          {"command", settings_.command(scene, state.pass_count)},
          {"full_size", picture.full_size},
          {"limitation", picture.limitation},
          {"camera", to_json(changes.look.value_or(home(picture.image)), is_mirrored_)},
          {"moved", changes.look.has_value()},
          {"lights", lights},
          {"paused", is_paused_},
          {"finished", phase == finished || phase == out_of_time},
          {"problem", problem_.empty() ? snapshot.status.problem : problem_}};
}

}  // namespace lanthorn::program
