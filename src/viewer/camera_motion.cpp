// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/camera_motion.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace lanthorn {

namespace {

// Axes of the camera in the world. If the camera's transform stretches, no axes of its film plane are at right angles;
// the view direction is what counts.
Direction axis(const CameraPose& pose, const Vec3& local) { return normalize(pose.camera_to_world.vector(local)); }

Transform about(const Point& centre, float degrees, const Direction& around) {
  return translate(centre) * rotate(degrees, around) * translate(-centre);
}

float degrees_between(const Direction& a, const Direction& b) {
  return std::atan2(glm::length(cross(a, b)), dot(a, b)) * 180 / pi;
}

// Turns the camera around `centre`. `arm`: a direction from the centre. `to_right`, `to_lower`: the directions in which
// the arm moves when the pointer moves right or down; they fix the signs of rotations, which depend on whether the
// camera mirrors.
struct Turn {
  Point centre;
  Direction arm;
  Direction to_right, to_lower;
};

CameraPose turned(const CameraPose& pose, const Vec2& degrees, const Turn& t) {
  constexpr float least_angle = 1;
  CameraPose result = pose;
  const Direction right = right_of(pose), forward = forward_of(pose);
  const float tilt_sign = dot(cross(right, t.arm), t.to_lower) > 0 ? 1.0f : -1.0f;
  // The rotation about `right` increases or decreases the angle between up and the view.
  const float growth = dot(cross(right, forward), pose.up) > 0 ? -1.0f : 1.0f;
  const float now = degrees_between(forward, pose.up);
  const float low = std::min(now, least_angle), high = std::max(now, 180 - least_angle);
  const float wanted = std::clamp(now + growth * tilt_sign * degrees.y, low, high);
  const Transform tilt = about(t.centre, growth * (wanted - now), right);
  const float side_sign = dot(cross(pose.up, t.arm), t.to_right) > 0 ? 1.0f : -1.0f;
  const Transform side = about(t.centre, side_sign * degrees.x, pose.up);
  result.camera_to_world = side * tilt * pose.camera_to_world;
  return result;
}

}  // namespace

CameraPose pose_of(const Transform& camera_to_world, float distance) {
  CameraPose pose{camera_to_world, distance, {}};
  const Direction up = camera_up_of(pose);
  int largest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::fabs(up[i]) > std::fabs(up[largest])) largest = i;
  pose.up = Direction(0);
  pose.up[largest] = up[largest] > 0 ? 1.0f : -1.0f;
  return pose;
}

CameraPose framing_pose(const description::Camera& camera, const Point& eye) {
  const Transform& given = camera.camera_to_world.start;
  const float distance = std::sqrt(distance_squared(given.point(camera.subject->centre()), eye));
  return pose_of(translate(eye - given.point(Point(0))) * given, distance);
}

description::Camera placed(description::Camera camera, const CameraPose& pose) {
  camera.camera_to_world = AnimatedTransform(pose.camera_to_world);
  camera.subject.reset();
  return camera;
}

Point eye_of(const CameraPose& pose) { return pose.camera_to_world.point(Point(0)); }
Direction forward_of(const CameraPose& pose) { return axis(pose, {0, 0, 1}); }
Direction right_of(const CameraPose& pose) { return axis(pose, {1, 0, 0}); }
Direction camera_up_of(const CameraPose& pose) { return axis(pose, {0, 1, 0}); }
Point pivot_of(const CameraPose& pose) { return eye_of(pose) + pose.distance * forward_of(pose); }

CameraPose orbit(const CameraPose& pose, const Vec2& degrees) {
  // Objects in front of the pivot follow the pointer if the eye moves the other way.
  return turned(pose, degrees, {pivot_of(pose), -forward_of(pose), -right_of(pose), camera_up_of(pose)});
}

CameraPose turn(const CameraPose& pose, const Vec2& degrees) {
  return turned(pose, degrees, {eye_of(pose), forward_of(pose), right_of(pose), -camera_up_of(pose)});
}

CameraPose pan(const CameraPose& pose, const Vec2& metres) {
  CameraPose result = pose;
  result.camera_to_world = translate(metres.y * camera_up_of(pose) - metres.x * right_of(pose)) * pose.camera_to_world;
  return result;
}

CameraPose zoom(const CameraPose& pose, float factor) {
  CameraPose result = pose;
  result.camera_to_world = translate((1 - factor) * pose.distance * forward_of(pose)) * pose.camera_to_world;
  result.distance = factor * pose.distance;
  return result;
}

CameraPose fly(const CameraPose& pose, const Vec3& metres) {
  CameraPose result = pose;
  const Vec3 way = metres.x * right_of(pose) + metres.y * pose.up + metres.z * forward_of(pose);
  result.camera_to_world = translate(way) * pose.camera_to_world;
  return result;
}

}  // namespace lanthorn
