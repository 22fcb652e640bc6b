// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <numbers>
#include <string_view>
#include <variant>

#include "lanthorn/error.h"
#include "lanthorn/session.h"
#include "scene_changes.h"
#include "value_types.h"

namespace lanthorn::program {

namespace {

using namespace description;

constexpr float degree = std::numbers::pi_v<float> / 180;

ValueType<Orbit> orbit_type() {
  const auto parse = [](std::string_view text) -> std::optional<Orbit> {
    constexpr double most = 1e6;
    const std::size_t comma = text.find(',');
    if (comma == text.npos) return std::nullopt;
    const auto yaw = parse_number(text.substr(0, comma)), pitch = parse_number(text.substr(comma + 1));
    if (!yaw || !pitch || std::abs(*yaw) > most || std::abs(*pitch) > most) return std::nullopt;
    return Orbit{static_cast<float>(*yaw), static_cast<float>(*pitch)};
  };
  return {"YAW,PITCH", "two numbers of degrees with a comma between them, e.g. 30,10", parse,
          [](const Orbit& orbit) { return fmt::format("{},{}", orbit.yaw, orbit.pitch); }};
}

// A camera's axes in world space when the shutter opens.
struct CameraAxes {
  Vec3 right, up, forward;  ///< unit length
  float scale;              ///< metres in world space per unit of camera space

  explicit CameraAxes(const Camera& camera) {
    const Transform& to_world = camera.camera_to_world.start;
    const Vec3 z = to_world.vector({0, 0, 1});
    scale = glm::length(z);
    forward = z / scale;
    right = glm::normalize(to_world.vector({1, 0, 0}));
    up = glm::normalize(to_world.vector({0, 1, 0}));
  }
  // The world's up axis.
  Vec3 upwards() const {
    const Vec3 axis = std::fabs(up.z) > std::fabs(up.y) ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
    return glm::dot(axis, up) < 0 ? -axis : axis;
  }
};

// The rotation about `axis` that moves objects in direction `from` towards `to`.
Transform turn_towards(float degrees, const Vec3& axis, const Vec3& from, const Vec3& to) {
  return rotate(glm::dot(glm::cross(axis, from), to) < 0 ? -degrees : degrees, axis);
}

// Rotation of a camera around its pivot; stops short of the poles.
Transform rotation(const CameraAxes& axes, const Orbit& orbit) {
  constexpr float steepest = 89;
  const Vec3 upwards = axes.upwards(), back = -axes.forward;
  const float elevation = std::asin(std::clamp(glm::dot(back, upwards), -1.0f, 1.0f)) / degree;
  const float pitch = std::clamp(elevation + orbit.pitch, -steepest, steepest) - elevation;
  const Transform tilt = orbit.pitch == 0 ? Transform() : turn_towards(pitch, axes.right, back, upwards);
  return turn_towards(orbit.yaw, upwards, back, axes.right) * tilt;
}

// The point on the camera's axis that is nearest to the centre of the scene.
Point pivot_of(const Camera& camera, const CameraAxes& axes, const Scene& scene) {
  const Point eye = camera.camera_to_world.start.point(Point(0));
  const Bounds bounds = summarize(scene).bounds;
  const float distance = bounds.empty() ? 0 : glm::dot(bounds.centre() - eye, axes.forward);
  return eye + (distance > 0 ? distance : axes.scale) * axes.forward;
}

void rotate_camera(Camera& camera, const Transform& rotation, const Point& pivot) {
  const Transform map = translate(pivot) * rotation * translate(-pivot);
  AnimatedTransform& to_world = camera.camera_to_world;
  to_world = {map * to_world.start, map * to_world.end, to_world.start_time, to_world.end_time};
}

// Box around the points that a camera frames, in the space that `from_world` maps to. Excludes points outside the
// camera's subject, such as those of large ground planes.
Bounds framed_by(const Camera& camera, const SceneModel& model, const Transform& from_world) {
  constexpr float slack = 1e-3f;
  const Transform to_camera = camera.camera_to_world.start.inverted();
  const Vec3 extent = camera.subject->extent(), margin(slack * std::max({extent.x, extent.y, extent.z}));
  const Vec3 low = camera.subject->min - margin, high = camera.subject->max + margin;
  Bounds bounds;
  for (const SceneModel::Instance& instance : model.instances) {
    const Transform map = from_world * instance.to_world, to_box = to_camera * instance.to_world;
    for (std::size_t m = instance.first_mesh; m < instance.first_mesh + instance.mesh_count; ++m)
      for (const Point& p : model.meshes[m].positions) {
        const Point at = to_box.point(p);
        if (glm::all(glm::greaterThanEqual(at, low)) && glm::all(glm::lessThanEqual(at, high)))
          bounds.extend(map.point(p));
      }
  }
  return bounds.empty() ? (from_world * camera.camera_to_world.start).bounds(*camera.subject) : bounds;
}

void orbit_camera(ViewDescription& view, const Orbit& orbit, const Scene& scene) {
  Camera& camera = view.camera;
  const Camera before = camera;
  const CameraAxes axes(camera);
  rotate_camera(camera, rotation(axes, orbit), pivot_of(camera, axes, scene));
  if (camera.subject) camera.subject = framed_by(before, model_of(scene), camera.camera_to_world.start.inverted());
}

PerspectiveCamera& perspective(Camera& camera, const char* option) {
  auto* const lens = std::get_if<PerspectiveCamera>(&camera.node);
  if (lens == nullptr)
    throw Error(camera.location,
                fmt::format("{}: the scene's camera is not a perspective camera, which this option needs", option));
  return *lens;
}

// Focal length, in metres, from the angle of view, for a film whose shorter side is 24 mm, as for 35 mm film.
float focal_length_of(const PerspectiveCamera& lens) {
  constexpr float half_film = 0.012f;
  return half_film / std::tan(0.5f * lens.fov * degree);
}

void set_aperture(Camera& camera, const LensChanges::Aperture& f_number) {
  PerspectiveCamera& lens = perspective(camera, "--aperture");
  lens.lens_radius = f_number ? focal_length_of(lens) / (2 * *f_number) / CameraAxes(camera).scale : 0;
}

// The view with a fixed camera position instead of a framed subject.
ViewDescription placed(const ViewDescription& view, const ViewOptions& options) {
  ViewDescription result = view;
  result.camera.camera_to_world = AnimatedTransform(camera_placement(view, options));
  result.camera.subject.reset();
  return result;
}

// In units of camera space. If the pixel sees no surface, focuses on the camera's pivot.
float depth_of_focus(const ViewDescription& view, const LensChanges::Focus& focus, const Scene& scene,
                     const ViewOptions& options) {
  const ViewDescription standing = placed(view, options);
  const Camera& camera = standing.camera;
  const CameraAxes axes(camera);
  if (focus) return *focus / axes.scale;
  if (const auto depth = depth_at(scene, standing, options)) return *depth;
  return glm::length(pivot_of(camera, axes, scene) - camera.camera_to_world.start.point(Point(0))) / axes.scale;
}

}  // namespace

void focus(ViewDescription& view, const LensChanges& lens, const Scene& scene, const ViewOptions& options) {
  const bool opens_aperture = lens.aperture && *lens.aperture;
  if (!lens.focus && !opens_aperture) return;
  Camera& camera = view.camera;
  const auto set = [&](float radius, float& distance) {
    if (!(radius > 0)) throw Error("--focus: the camera has no aperture, so everything is in focus; add --aperture");
    distance = depth_of_focus(view, lens.focus.value_or(LensChanges::Focus()), scene, options);
  };
  if (auto* const thin = std::get_if<PerspectiveCamera>(&camera.node))
    return set(thin->lens_radius, thin->focal_distance);
  if (auto* const parallel = std::get_if<OrthographicCamera>(&camera.node))
    return set(parallel->lens_radius, parallel->focal_distance);
  if (auto* const real = std::get_if<RealisticCamera>(&camera.node)) return set(1, real->focus_distance);
  throw Error(camera.location, "--focus: the scene's camera has no lens");
}

void change_lens(ViewDescription& view, const LensChanges& lens, const Scene& scene, const ViewOptions& options) {
  if (lens.fov) perspective(view.camera, "--fov").fov = *lens.fov;
  if (lens.orbit) orbit_camera(view, *lens.orbit, scene);
  if (lens.aperture) set_aperture(view.camera, *lens.aperture);
  focus(view, lens, scene, options);
}

LensNumbers lens_of(const ViewDescription& view) {
  const Camera& camera = view.camera;
  const float scale = CameraAxes(camera).scale;
  if (const auto* const thin = std::get_if<PerspectiveCamera>(&camera.node)) {
    if (!(thin->lens_radius > 0)) return {.fov = thin->fov};
    return {thin->fov, focal_length_of(*thin) / (2 * thin->lens_radius * scale), thin->focal_distance * scale};
  }
  if (const auto* const parallel = std::get_if<OrthographicCamera>(&camera.node); parallel && parallel->lens_radius > 0)
    return {.focus = parallel->focal_distance * scale};
  if (const auto* const real = std::get_if<RealisticCamera>(&camera.node))
    return {.focus = real->focus_distance * scale};
  return {};
}

float focus_at(const ViewDescription& view, const Scene& scene, const ViewOptions& options, const Vec2& pixel) {
  const ViewDescription standing = placed(view, options);
  const auto depth = depth_at(scene, standing, options, pixel);
  if (!depth) throw Error("nothing is seen there that could be sharp");
  return *depth * CameraAxes(standing.camera).scale;
}

std::vector<ViewDescription> turntable(const ViewDescription& view, const Scene& scene, std::size_t count) {
  const CameraAxes axes(view.camera);
  const Point pivot = pivot_of(view.camera, axes, scene);
  std::vector<ViewDescription> views(count, view);
  for (std::size_t i = 0; i < count; ++i) {
    const float yaw = 360 * static_cast<float>(i) / static_cast<float>(count);
    rotate_camera(views[i].camera, rotation(axes, {yaw, 0}), view.camera.subject ? Point(0) : pivot);
  }
  if (!view.camera.subject) return views;
  // One common box for all views, around the centre of what is framed.
  const SceneModel model = model_of(scene);
  const Point centre = framed_by(view.camera, model, {}).centre();
  Vec3 half(0);
  for (const ViewDescription& placed : views) {
    const Transform to_camera = placed.camera.camera_to_world.start.inverted();
    const Bounds box = framed_by(view.camera, model, to_camera);
    half = glm::max(half, glm::max(box.max - to_camera.point(centre), to_camera.point(centre) - box.min));
  }
  for (ViewDescription& placed : views) {
    const Point middle = placed.camera.camera_to_world.start.inverted().point(centre);
    placed.camera.subject = Bounds{middle - half, middle + half};
  }
  return views;
}

namespace {

constexpr double narrowest = 0.01, widest = 179, largest_aperture = 0.1, farthest = 1e12;

}  // namespace

ValueType<float> fov_type() { return number_type<float>({narrowest, widest}); }
ValueType<LensChanges::Aperture> aperture_type() { return number_or_word_type({largest_aperture, farthest}, "off"); }
ValueType<LensChanges::Focus> focus_type() { return number_or_word_type({1e-9, farthest}, "auto"); }

OptionTable lens_options(LensChanges& lens) {
  return {
      {.names = "--orbit",
       .value = into(lens.orbit, orbit_type()),
       .brief = "Turn the camera around its target, in degrees",
       .details = "YAW turns to the right, PITCH upwards. A model without a camera is framed from the new direction.",
       .excludes = "--look-at"},
      {.names = "--fov",
       .value = into(lens.fov, fov_type()),
       .brief = "Angle of view over the shorter side, in degrees",
       .details = "The camera stays in its place. For a model without a camera, the distance changes so that the model "
                  "fills the picture as before.",
       .otherwise = "the scene file's"},
      {.names = "--aperture",
       .value = into(lens.aperture, aperture_type()),
       .brief = "f-number such as 2.8; off: everything is sharp",
       .details = "Smaller numbers blur more. The scene's unit is the metre; the film is 24 mm along its shorter side.",
       .otherwise = "the scene file's, else off"},
      {.names = "--focus",
       .value = into(lens.focus, focus_type()),
       .brief = "Focus distance in metres, or auto: the surface at the picture's centre",
       .otherwise = "with --aperture auto, else the scene file's"}};
}

}  // namespace lanthorn::program
