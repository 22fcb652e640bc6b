// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Turns the user's input into camera motion, and into picking and dragging of lights and objects.
#pragma once

#include "camera/view.h"
#include "viewer/camera_motion.h"
#include "viewer/edited_scene.h"
#include "viewer/panel.h"
#include "viewer/picking.h"

namespace lanthorn {

class Interaction {
 public:
  /// `speed`: of flying, m/s.
  Interaction(const CameraPose& pose, float speed) : pose_(pose), home_(pose), speed_(speed) {}

  struct Change {
    bool camera = false, scene = false;
  };
  /// Applies one frame's input. `view`: the view of the pose before. Selects in `panel` and edits `scene`; an edit that
  /// the scene refuses leaves its reason in `panel.message`.
  Change apply(const Input& input, const View& view, const Picker& picker, EditedScene& scene, Panel& panel);

  const CameraPose& pose() const { return pose_; }
  void go_home() { pose_ = home_; }

 private:
  enum class Drag : std::uint8_t { none, orbit, turn, pan, light, object };

  void begin(Input input, const View& view, const Picker& picker, const EditedScene& scene, Panel& panel);
  void select(const Input& input, const View& view, const Picker& picker, const EditedScene& scene, Panel& panel) const;
  bool move_camera(const Input& input, const View& view);
  bool move_selected(const Input& input, const View& view, EditedScene& scene, Panel& panel) const;

  CameraPose pose_, home_;
  float speed_;
  Drag drag_ = Drag::none;
  float drag_depth_ = 0;  // of the dragged thing, along the view, m
  Vec2 way_{0};           // of the pointer since a button was pressed, pixels
};

/// The ray through a place of the picture, pixels.
Ray ray_through(const View& view, const Vec2& pixel);
/// The way from the point under `from` to the point under `to`, both in the plane at `depth` before the eye, m.
Vec3 way_between(const View& view, const Direction& forward, float depth, const Vec2& from, const Vec2& to);
/// Places of the lights that have one and are in view.
std::vector<LightMark> light_marks(const View& view, const std::vector<LightRow>& lights);

}  // namespace lanthorn
