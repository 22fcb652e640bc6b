// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/interaction.h"

#include <cmath>

#include "math/vec.h"

namespace lanthorn {

namespace {

constexpr float degrees_per_picture = 180;  // of a turn by a drag over the height of the picture
constexpr float click_pixels = 4;           // a shorter motion is no drag yet, at 720 rows
constexpr float mark_pixels = 14;           // around a light's mark, at 720 rows

float rows(const View& view) { return static_cast<float>(view.window.height()); }
float at_720_rows(const View& view, float pixels) { return pixels * rows(view) / 720; }

std::optional<std::size_t> mark_under(const Input& input, const View& view, const EditedScene& scene) {
  std::optional<std::size_t> found;
  float nearest = std::max(3.0f, at_720_rows(view, mark_pixels));
  for (const LightMark& mark : light_marks(view, scene.lights()))
    if (const float away = glm::length(mark.at - input.pointer); away < nearest) {
      nearest = away;
      found = mark.light;
    }
  return found;
}

float depth_of(const CameraPose& pose, const Point& p) { return dot(p - eye_of(pose), forward_of(pose)); }

}  // namespace

Ray ray_through(const View& view, const Vec2& pixel) {
  const Vec2 raster = Vec2(static_cast<float>(view.window.x0), static_cast<float>(view.window.y0)) + pixel;
  return view.camera.sample_ray(raster, Vec2(0.5f), view.camera.time(0)).ray;
}

Vec3 way_between(const View& view, const Direction& forward, float depth, const Vec2& from, const Vec2& to) {
  const auto place = [&](const Vec2& pixel) {
    const Ray ray = ray_through(view, pixel);
    // The origins of an orthographic camera's rays lie in a plane across the view.
    return ray.origin + depth / std::max(1e-3f, dot(ray.direction, forward)) * ray.direction;
  };
  return place(to) - place(from);
}

std::vector<LightMark> light_marks(const View& view, const std::vector<LightRow>& lights) {
  std::vector<LightMark> marks;
  const Vec2 corner(static_cast<float>(view.window.x0), static_cast<float>(view.window.y0));
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!lights[i].position) continue;
    if (const auto seen = view.camera.connect(*lights[i].position, Vec2(0.5f), view.camera.time(0)))
      marks.push_back({seen->raster - corner, i});
  }
  return marks;
}

void Interaction::begin(Input input, const View& view, const Picker& picker, const EditedScene& scene, Panel& panel) {
  way_ = Vec2(0);
  input.pointer -= input.moved;  // where the button was pressed
  if (input.middle || (input.left && input.shift)) {
    drag_ = Drag::pan;
    return;
  }
  if (input.right) {
    drag_ = Drag::turn;
    return;
  }
  drag_ = Drag::orbit;
  if (const auto light = mark_under(input, view, scene)) {
    drag_ = Drag::light;
    panel.selected_light = light;
    panel.selected_object.reset();
    drag_depth_ = depth_of(pose_, *scene.lights()[*light].position);
    return;
  }
  if (!panel.selected_object) return;
  const Ray ray = ray_through(view, input.pointer);
  const auto hit = picker.pick(ray, scene.description().instances);
  if (!hit || hit->instance != panel.selected_object) return;
  drag_ = Drag::object;
  drag_depth_ = depth_of(pose_, ray.origin + hit->distance * ray.direction);
}

void Interaction::select(const Input& input, const View& view, const Picker& picker, const EditedScene& scene,
                         Panel& panel) const {
  panel.selected_light.reset();
  panel.selected_object.reset();
  const auto hit = picker.pick(ray_through(view, input.pointer), scene.description().instances);
  if (!hit) return;
  for (std::size_t i = 0; hit->area_light && i < scene.lights().size(); ++i)
    if (scene.lights()[i].is_area && scene.lights()[i].index == *hit->area_light) panel.selected_light = i;
  if (!panel.selected_light) panel.selected_object = hit->instance;
}

bool Interaction::move_camera(const Input& input, const View& view) {
  const CameraPose before = pose_;
  const Vec2 degrees = degrees_per_picture / rows(view) * input.moved;
  if (drag_ == Drag::orbit) pose_ = orbit(pose_, degrees);
  if (drag_ == Drag::turn) pose_ = turn(pose_, -0.5f * degrees);  // what is seen follows the pointer
  if (drag_ == Drag::pan) {
    const Vec3 way = way_between(view, forward_of(pose_), pose_.distance, input.pointer - input.moved, input.pointer);
    pose_ = pan(pose_, {dot(way, right_of(pose_)), -dot(way, camera_up_of(pose_))});
  }
  constexpr float step = 0.85f;  // of a notch of the wheel
  if (input.inside && input.wheel != 0) pose_ = zoom(pose_, std::pow(step, input.wheel));
  constexpr float faster = 4;
  if (input.fly != Vec3(0)) pose_ = fly(pose_, input.seconds * speed_ * (input.shift ? faster : 1) * input.fly);
  return !(before.camera_to_world == pose_.camera_to_world);
}

bool Interaction::move_selected(const Input& input, const View& view, EditedScene& scene, Panel& panel) const {
  if (input.moved == Vec2(0)) return false;
  const Vec3 way = way_between(view, forward_of(pose_), drag_depth_, input.pointer - input.moved, input.pointer);
  try {
    if (drag_ == Drag::light)
      scene.move_light(*panel.selected_light, way);
    else
      scene.move_instance(*panel.selected_object, way);
    return true;
  } catch (const Error& e) {
    panel.message = e.message;
    return false;
  }
}

Interaction::Change Interaction::apply(const Input& input, const View& view, const Picker& picker, EditedScene& scene,
                                       Panel& panel) {
  Change change;
  if (input.forget) {
    panel.selected_light.reset();
    panel.selected_object.reset();
  }
  if (input.pressed && input.inside && drag_ == Drag::none) begin(input, view, picker, scene, panel);
  way_ += glm::abs(input.moved);
  const bool is_drag = way_.x + way_.y > at_720_rows(view, click_pixels);
  const bool drags_selected = drag_ == Drag::light || drag_ == Drag::object;
  if (drags_selected && is_drag) change.scene = move_selected(input, view, scene, panel);
  Input of_camera = input;
  if (!is_drag) of_camera.moved = Vec2(0);
  change.camera = move_camera(of_camera, view);
  if (!input.left && !input.middle && !input.right) {
    if (drag_ == Drag::orbit && !is_drag && input.released) select(input, view, picker, scene, panel);
    drag_ = Drag::none;
  }
  return change;
}

}  // namespace lanthorn
