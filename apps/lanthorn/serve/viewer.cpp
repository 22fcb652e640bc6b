// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "../report_json.h"
#include "../value_types.h"
#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/session.h"
#include "lanthorn/text.h"

namespace lanthorn::program {

namespace {

using namespace std::chrono_literals;

constexpr std::chrono::milliseconds watched_time = 30s, frame_patience = 10s;

// Distance to the point that a camera orbits: the centre of what it frames; or else the surface at the centre of the
// picture, or the scene's centre. The picture's centre is unreliable for framed models: through the hole of a ring it
// shows a point far behind it.
double distance_to_subject(const description::Camera& camera, const DVec3& eye) {
  return glm::length(DVec3(camera.camera_to_world.start.point(camera.subject->centre())) - eye);
}
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

// Current values of the lens; the f-number as it was given.
nlohmann::json to_json(const LensChanges& changes, const ViewDescription& view) {
  LensNumbers lens = lens_of(view);
  if (changes.aperture) lens.aperture = *changes.aperture;
  const bool is_auto = changes.focus ? !*changes.focus : changes.aperture && *changes.aperture;
  return {{"fov", or_null(lens.fov)},
          {"aperture", or_null(lens.aperture)},
          {"focus", or_null(lens.focus)},
          {"focuses_middle", is_auto},
          {"frames_subject", view.camera.subject.has_value()}};
}

nlohmann::json to_json(const std::shared_ptr<const InteractiveDenoised>& denoised) {
  if (!denoised) return nullptr;
  return {{"passes", denoised->passes}, {"preview", denoised->is_preview}};
}

// Without a limit on passes, time or error, a view refines until it changes.
RenderOptions endless(RenderOptions options) {
  if (!options.passes && !options.seconds && !options.noise) options.passes = most_passes;
  return options;
}

}  // namespace

Viewer::Viewer(const SharedScene& scene, ViewerSettings settings)
    : scene_(scene),
      settings_(std::move(settings)),
      is_mirrored_(description_of(*scene).view.camera.camera_to_world.start.swaps_handedness()),
      render_(scale_lights(scene_, settings_.start.changes.lights),
              view_of(*scene_, settings_.start.changes, settings_.start.options), endless(settings_.start.options),
              {.keeps_sums = settings_.keeps_sums, .denoises = settings_.denoises}),
      surroundings_{{settings_.start.environment.source, scene_}},
      lights_(lights_of(*scene_)),
      wanted_{settings_.start, first_view()},
      scenes_{{render_.snapshot().status.revision, wanted_}},
      denoises_(settings_.denoises),
      watched_until_(Clock::now() + watched_time) {}

void Viewer::tend() {
  const std::lock_guard lock(mutex_);
  const InteractiveSnapshot now = render_.snapshot();
  const bool is_refused = now.status.phase == InteractivePhase::failed && now.picture &&
                          now.picture->revision != now.status.revision && scenes_.contains(now.picture->revision);
  if (is_refused) {
    problem_ = now.status.problem;
    submit(scenes_.at(now.picture->revision).scene, /*is_moving=*/false);
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

bool Viewer::denoises() const {
  const std::lock_guard lock(mutex_);
  return denoises_;
}

void Viewer::look() {
  watched_until_ = Clock::now() + watched_time;
  render_.pause(is_paused_);
}

RenderOptions Viewer::edited_options(const ViewerEdit& edit) const {
  const RenderOptions& start = settings_.start.options;
  RenderOptions options = wanted_.scene.options;
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

std::vector<std::string> Viewer::environments() const {
  std::vector<std::string> sources{""};
  for (std::string& name : environment_names()) sources.push_back(std::move(name));
  const std::string& start = settings_.start.environment.source;
  if (std::find(sources.begin(), sources.end(), start) == sources.end()) sources.push_back(start);
  return sources;
}

std::vector<NamedLight> Viewer::lights() const {
  const std::lock_guard lock(mutex_);
  return lights_;
}

SharedScene Viewer::in_environment(const EnvironmentChoice& choice) {
  const auto edit = [&](const SharedScene& scene) {
    SceneDescription description = description_of(*scene);
    replace_environment(description, choice);
    return build_scene(std::move(description), scene);
  };
  SharedScene& first = surroundings_[choice.source];
  if (!first) first = edit(scene_);
  return description_of(*first).environment == choice ? first : edit(first);
}

// Lights that are the same in both environments keep their factors.
void Viewer::edit_environment(ViewerScene& next, const EnvironmentChoice& choice) {
  const std::vector<std::string> known = environments();
  if (std::find(known.begin(), known.end(), choice.source) == known.end())
    throw Error(
        fmt::format("environment {}: expected one of the environments that the page offers", printable(choice.source)));
  next.environment = choice.source.empty() ? EnvironmentChoice() : choice;
  next.environment.up = settings_.start.environment.up;
  const std::vector<NamedLight> now = lights_of(*in_environment(next.environment));
  const auto has = [](const std::vector<NamedLight>& lights, const NamedLight& light) {
    return std::any_of(lights.begin(), lights.end(),
                       [&](const NamedLight& other) { return other.id == light.id && other.words == light.words; });
  };
  for (const NamedLight& light : lights_)
    if (!has(now, light)) next.changes.lights.erase(light.id);
}

void Viewer::edit_lens(ViewerScene& next, const ViewerEdit& edit) const {
  LensChanges& lens = next.changes.lens;
  if (edit.lens.fov) lens.fov = edit.lens.fov;
  if (edit.lens.focus) lens.focus = edit.lens.focus;
  if (edit.lens.aperture) lens.aperture = edit.lens.aperture;
  if (lens.aperture && !*lens.aperture) lens.focus.reset();
  if (!edit.focus_at) return;
  const auto& crop = next.options.crop;
  const Vec2 corner = crop ? Vec2((*crop)[0], (*crop)[1]) : Vec2(0);
  const ViewDescription view = view_of(*scene_, next.changes, next.options);
  lens.focus = LensChanges::Focus(focus_at(view, *scene_, next.options, corner + *edit.focus_at));
}

std::uint64_t Viewer::apply(const ViewerEdit& edit) {
  if (edit.look) check(*edit.look);
  const std::lock_guard lock(mutex_);
  const ViewerScene& now = wanted_.scene;
  ViewerScene next{edit.home ? settings_.start.changes : now.changes, edited_options(edit), now.environment};
  if (edit.look) move_camera(next.changes, *edit.look);
  if (edit.environment) edit_environment(next, *edit.environment);
  if (edit.lights) next.changes.lights = *edit.lights;
  edit_lens(next, edit);
  if (edit.size) check_view(view_of(*scene_, next.changes, next.options), next.options);
  const std::uint64_t revision = submit(std::move(next), edit.moving);
  problem_.clear();
  if (edit.paused) is_paused_ = *edit.paused;
  if (edit.denoise) {
    denoises_ = *edit.denoise;
    render_.denoise(denoises_);
  }
  look();
  return revision;
}

std::uint64_t Viewer::submit(ViewerScene next, bool is_moving) {
  RenderEdit edit{.is_moving = is_moving};
  const RenderOptions &before = wanted_.scene.options, &now = next.options;
  const SceneChanges &old = wanted_.scene.changes, &changes = next.changes;
  const bool is_relit = next.environment != wanted_.scene.environment;
  // The surface at the picture's centre depends on its aspect ratio.
  if (changes.look != old.look || changes.lens != old.lens || now.resolution != before.resolution)
    edit.view = view_of(*scene_, changes, now);
  if (changes.lights != old.lights || is_relit) {
    const SharedScene scene = in_environment(next.environment);
    edit.scene = [lit = scale_lights(scene, changes.lights)] { return lit; };
    if (is_relit) lights_ = lights_of(*scene);
  }
  if (now.integrator != before.integrator || now.set != before.set || now.resolution != before.resolution)
    edit.options = endless(now);
  wanted_ = {std::move(next), edit.view.value_or(wanted_.view)};
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

// Each snapshot becomes one frame, however many pages request it.
std::shared_ptr<const PageFrame> Viewer::frame_of(const InteractiveSnapshot& snapshot) {
  const std::lock_guard lock(mutex_);
  if (!snapshot.picture || (frame_ && frame_->number() >= snapshot.number)) return frame_;
  if (first_method_.empty()) first_method_ = snapshot.picture->state.integrator;
  nlohmann::json metadata = settings_json(snapshot.picture->state.record)["identity"];
  metadata["passes"] = snapshot.picture->state.pass_count;
  const std::shared_ptr<const Image> image(snapshot.picture, &snapshot.picture->image);
  std::shared_ptr<const Image> denoised;
  if (snapshot.denoised) denoised = {snapshot.denoised, &snapshot.denoised->image};
  frame_ = std::make_shared<const PageFrame>(snapshot.number, image, denoised, about(snapshot), metadata.dump());
  scenes_.erase(scenes_.begin(), scenes_.lower_bound(snapshot.picture->revision));
  return frame_;
}

const LookAt& Viewer::home(const Image& image) {
  if (!home_) {
    const RenderOptions& options = settings_.start.options;
    const ViewDescription own = view_of(*scene_, moved(settings_.start.changes, {}, {}), options);
    const DVec3& origin = description_of(*scene_).origin;
    const DVec3 eye = look_of(own, options, 1, origin).eye;
    const float distance = own.camera.subject ? static_cast<float>(distance_to_subject(own.camera, eye - origin))
                                              : distance_to_middle(image, *scene_, eye);
    home_ = look_of(own, options, distance, origin);
  }
  return *home_;
}

nlohmann::json Viewer::about(const InteractiveSnapshot& snapshot) {
  using enum InteractivePhase;
  const InteractivePicture& picture = *snapshot.picture;
  const StateSummary& state = picture.state;
  const auto& [scene, view] = scenes_.at(picture.revision);
  const SceneChanges& changes = scene.changes;
  const InteractivePhase phase = snapshot.status.phase;
  nlohmann::json lights = nlohmann::json::object();
  for (const auto& [name, factor] : changes.lights) lights[name] = factor;
  return {{"revision", picture.revision},
          {"coarse", picture.is_coarse},
          {"passes", state.pass_count},
          {"seconds", state.seconds},
          {"samples", static_cast<double>(state.pass_count) * state.width * state.height},
          {"photons", state.pass_count * state.record.identity.photons},
          {"traces_photons", picture.statistics.light_paths > 0},
          {"error", picture.statistics.error ? describe_error(*picture.statistics.error) : ""},
          {"seconds_left", or_null(picture.seconds_left)},
          {"radius", picture.statistics.radius},
          {"volume_radius", picture.statistics.volume_radius},
          {"integrator", state.integrator},
          {"denoise", denoises_},
          {"denoised", to_json(snapshot.denoised)},
          {"command", settings_.command(scene, state.pass_count, denoises_)},
          {"full_size", picture.full_size},
          {"limitation", picture.limitation},
          {"remark", picture.remark},
          {"camera", to_json(changes.look.value_or(home(picture.image)), is_mirrored_)},
          {"moved", changes.look.has_value() || changes.lens != settings_.start.changes.lens},
          {"lens", to_json(changes.lens, view)},
          {"environment",
           {{"source", scene.environment.source},
            {"rotation", scene.environment.rotation},
            {"scale", scene.environment.scale}}},
          {"lights", lights},
          {"paused", is_paused_},
          {"finished", phase == finished || phase == out_of_time},
          {"problem", problem_.empty() ? snapshot.status.problem : problem_}};
}

}  // namespace lanthorn::program
