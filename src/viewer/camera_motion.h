// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Camera motion by the user: rigid motions of the camera in the world. Mirroring cameras stay mirroring.
#pragma once

#include "lanthorn/scene_description.h"
#include "lanthorn/transform.h"
#include "lanthorn/vec.h"

namespace lanthorn {

/// A camera's place, and the point that it turns around.
struct CameraPose {
  Transform camera_to_world;  ///< camera space: x to the right, y up, z forward
  float distance = 1;         ///< from the eye to the pivot, along the view, m
  Direction up{0, 1, 0};      ///< of the world: the axis of turns to the side
};

/// The pose of a camera when its shutter opens. The world's up is the axis of the world nearest to the camera's, with
/// its sign.
CameraPose pose_of(const Transform& camera_to_world, float distance);
/// The pose of a camera that frames its subject from `eye` (see `framing`): it turns around the middle of the subject.
CameraPose framing_pose(const description::Camera& camera, const Point& eye);
/// A camera in this place, without motion.
description::Camera placed(description::Camera camera, const CameraPose& pose);

Point eye_of(const CameraPose& pose);
Direction forward_of(const CameraPose& pose);
Direction right_of(const CameraPose& pose);
Direction camera_up_of(const CameraPose& pose);
Point pivot_of(const CameraPose& pose);

// `degrees` and `metres`: x to the right, y down on the screen, as the pointer moves.

/// Turns around the pivot, so that objects in front of it follow the pointer. Stops 1° before the world's up and down.
CameraPose orbit(const CameraPose& pose, const Vec2& degrees);
/// Turns the camera about its eye, towards where the pointer goes. Stops 1° before the world's up and down.
CameraPose turn(const CameraPose& pose, const Vec2& degrees);
/// Shifts the camera in its film plane, so that the pivot follows the pointer.
CameraPose pan(const CameraPose& pose, const Vec2& metres);
/// Multiplies the distance to the pivot by `factor` > 0.
CameraPose zoom(const CameraPose& pose, float factor);
/// Moves by `metres` along the camera's right, the world's up and the camera's forward axis; the pivot moves along.
CameraPose fly(const CameraPose& pose, const Vec3& metres);

}  // namespace lanthorn
