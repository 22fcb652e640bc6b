// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/camera_motion.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "camera/view.h"
#include "math/vec.h"

namespace lanthorn::camera_motion_test {
namespace {

void expect_near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

// A level camera at (0, 1, 5) that looks at (0, 1, 0): as pbrt's LookAt makes it, or mirrored as glTF's reader does.
CameraPose pose(bool mirrored) {
  Transform to_world = look_at({0, 1, 5}, {0, 1, 0}, {0, 1, 0}).inverted();
  if (mirrored) to_world = to_world * scale({-1, 1, 1});
  return pose_of(to_world, 5);
}

/// Screen position of a point, relative to its depth: x to the right, y down.
Vec2 on_screen(const CameraPose& pose, const Point& p) {
  const Vec3 local = pose.camera_to_world.inverse * glm::vec4(p, 1.0f);
  return {local.x / local.z, -local.y / local.z};
}

class CameraMotion : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Handedness, CameraMotion, testing::Values(false, true));

// The pivot is the middle of the subject even if nothing is visible there, as in a ring.
TEST(FramingPose, TurnsAroundTheMiddleOfTheSubject) {
  ViewDescription description;
  description::Camera& camera = description.camera;
  camera.node = description::PerspectiveCamera{.fov = 40};
  camera.camera_to_world = AnimatedTransform(look_at({3, 1, 5}, {0, 1, 0}, {0, 1, 0}).inverted());
  camera.subject = Bounds{Point(1, -2, -3), Point(2, 1, 1)};
  const View view = make_view(description, {.resolution = std::array{80, 60}});
  const Point eye = view.camera.sample_ray({40, 30}, {0.5f, 0.5f}, 0).ray.origin;
  const CameraPose pose = framing_pose(camera, eye);
  expect_near(eye_of(pose), eye, 1e-4f);
  expect_near(pivot_of(pose), camera.camera_to_world.start.point(camera.subject->centre()), 1e-4f);
}

TEST_P(CameraMotion, OrbitKeepsThePivotTheDistanceAndTheHorizon) {
  const CameraPose before = pose(GetParam());
  const CameraPose after = orbit(before, {37, 21});
  expect_near(pivot_of(after), {0, 1, 0});
  EXPECT_NEAR(std::sqrt(distance_squared(eye_of(after), Point(0, 1, 0))), 5, 1e-5f);
  EXPECT_NEAR(dot(right_of(after), Vec3(0, 1, 0)), 0, 1e-6f);
  EXPECT_EQ(after.camera_to_world.swaps_handedness(), before.camera_to_world.swaps_handedness());
  // Moving the pointer down raises the camera, by as many degrees.
  EXPECT_NEAR(eye_of(after).y - 1, 5 * std::sin(to_radians(21)), 1e-4f);
}

TEST_P(CameraMotion, WhatIsBeforeThePivotFollowsTheHand) {
  const CameraPose before = pose(GetParam());
  const Point near = before.camera_to_world.point({0, 0, 4});
  EXPECT_GT(on_screen(orbit(before, {5, 0}), near).x, 0.01f);
  EXPECT_LT(on_screen(orbit(before, {-5, 0}), near).x, -0.01f);
  EXPECT_GT(on_screen(orbit(before, {0, 5}), near).y, 0.01f);
  EXPECT_LT(on_screen(orbit(before, {0, -5}), near).y, -0.01f);
}

TEST_P(CameraMotion, OrbitStopsBeforeThePoles) {
  for (const float degrees : {500.0f, -500.0f}) {
    const CameraPose after = orbit(pose(GetParam()), {0, degrees});
    EXPECT_NEAR(std::fabs(forward_of(after).y), std::cos(to_radians(1)), 1e-5f);
    EXPECT_GT(camera_up_of(after).y, 0) << "the camera does not turn over";
    EXPECT_GT(camera_up_of(orbit(after, {90, 0})).y, 0);
  }
}

TEST_P(CameraMotion, TurningLooksToWhereTheHandGoesFromTheSameEye) {
  const CameraPose before = pose(GetParam());
  const CameraPose after = turn(before, {10, 4});
  expect_near(eye_of(after), {0, 1, 5});
  EXPECT_GT(dot(forward_of(after), right_of(before)), 0.1f);
  EXPECT_NEAR(forward_of(after).y, -std::sin(to_radians(4)), 1e-5f);
  EXPECT_NEAR(dot(right_of(after), Vec3(0, 1, 0)), 0, 1e-6f);
}

TEST_P(CameraMotion, PanMovesThePivotWithTheHand) {
  const CameraPose before = pose(GetParam());
  const CameraPose after = pan(before, {0.5f, 0.25f});
  const Vec2 seen = on_screen(after, pivot_of(before));
  EXPECT_NEAR(seen.x, 0.5f / 5, 1e-6f);
  EXPECT_NEAR(seen.y, 0.25f / 5, 1e-6f);
  expect_near(forward_of(after), forward_of(before));
}

TEST_P(CameraMotion, ZoomScalesTheDistanceAndFlyingTakesThePivotAlong) {
  const CameraPose before = pose(GetParam());
  const CameraPose nearer = zoom(before, 0.5f);
  expect_near(pivot_of(nearer), {0, 1, 0});
  EXPECT_FLOAT_EQ(nearer.distance, 2.5f);
  expect_near(eye_of(nearer), {0, 1, 2.5f});
  const CameraPose flown = fly(before, {0, 0.5f, 2});
  expect_near(eye_of(flown), {0, 1.5f, 3});
  expect_near(pivot_of(flown), {0, 1.5f, -2});
  expect_near(eye_of(fly(before, {1, 0, 0})) - eye_of(before), right_of(before));
}

TEST(CameraMotionPose, TheWorldsUpIsTheAxisNearestToTheCameras) {
  expect_near(pose_of(look_at({3, -4, 2}, {0, 0, 0}, {0, 0, 1}).inverted(), 1).up, {0, 0, 1});
  expect_near(pose_of(look_at({0, 0, 2}, {0, 0, 0}, {0, -1, 0}).inverted(), 1).up, {0, -1, 0});
}

TEST(CameraMotionPose, APlacedCameraStandsStillAndFramesNothing) {
  description::Camera camera;
  camera.subject = Bounds{Point(-1), Point(1)};
  camera.camera_to_world = AnimatedTransform(translate({1, 0, 0}), translate({2, 0, 0}), 0, 1);
  const CameraPose p = pose(false);
  const description::Camera result = placed(camera, p);
  EXPECT_FALSE(result.subject);
  EXPECT_FALSE(result.camera_to_world.is_moving());
  EXPECT_EQ(result.camera_to_world.start, p.camera_to_world);
}

}  // namespace
}  // namespace lanthorn::camera_motion_test
