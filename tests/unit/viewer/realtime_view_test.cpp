// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/realtime_view.h"

#include <gtest/gtest.h>

#include <string>

#include "support/render_scene.h"

namespace lanthorn::realtime_view_test {
namespace {

FrameReport with_eye_paths(double milliseconds) {
  FrameReport report;
  report.stages = {{"direct light", 500}, {eye_path_stage, milliseconds}};
  return report;
}

// A block of 1 m seen from a distance of 4 m, on planes of 4 m and 4 km, under a lamp: the photon radius and the
// ambient light fit what is in view.
TEST(RealtimeSettings, FitWhatIsSeenOfALargeScene) {
  const auto settings = [](const std::string& half) {
    const Scene scene = test::scene_from_text(R"(
LookAt 0 1 -4  0 .5 0  0 1 0
Camera "perspective" "float fov" [20]
WorldBegin
LightSource "point" "rgb I" [9 9 9] "point3 from" [0 3 -2]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-.5 0 0  .5 0 0  .5 1 0  -.5 1 0]
Scale )" + half + " 1 " + half + R"(
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 -1  1 0 -1  1 0 1  -1 0 1]
)");
    return realtime_settings(scene, make_view(scene.description().view), {});
  };
  const RealtimeSettings small = settings("2"), large = settings("2000");
  const auto number = [](const RealtimeSettings& s, const char* name) { return std::stod(s.values.at(name)); };
  EXPECT_NEAR(number(small, "radius"), 0.05 * 2.9, 0.01);
  EXPECT_LT(number(large, "radius"), 10 * number(small, "radius"));
  EXPECT_GT(number(large, "ambient"), number(small, "ambient") / 100);
}

// A picture does not start with the coloured noise of dispersive glass.
TEST(FrameSettings, FirstFramesAreWithoutDispersion) {
  const Scene scene = test::scene_from_text(R"(WorldBegin
Shape "sphere"
)");
  const View view = make_view(scene.description().view);
  const RealtimeSettings settings = realtime_settings(scene, view, {});
  EXPECT_FALSE(frame_settings(settings, view, 0).disperses);
  EXPECT_TRUE(frame_settings(settings, view, 100).disperses);
}

// On a processor that takes 900 ms for one path in each pixel, the spacing is found within a frame, stays, and shrinks
// when few pixels need paths.
TEST(EyePathSpacing, FitsTheTimeOfAFrame) {
  EyePathSpacing spacing;
  EXPECT_EQ(spacing.pixels(), 1);
  spacing.learn(with_eye_paths(900), 1);
  EXPECT_EQ(spacing.pixels(), 6);
  spacing.learn(with_eye_paths(900. / 36), 6);
  EXPECT_EQ(spacing.pixels(), 6);
  spacing.learn(with_eye_paths(1), 6);
  EXPECT_EQ(spacing.pixels(), 2);
  spacing.learn(with_eye_paths(9), 2);
  EXPECT_EQ(spacing.pixels(), 2);
  spacing.learn(FrameReport{}, 2);
  EXPECT_EQ(spacing.pixels(), 1);
  spacing.learn(with_eye_paths(1e5), 1);
  EXPECT_EQ(spacing.pixels(), 8);
}

// A driver that takes 500 ms for a full frame, of which 20 ms do not depend on the number of pixels.
TEST(MovingResolution, IsThatOfTenFramesASecondAtLeast) {
  MovingResolution resolution;
  EXPECT_EQ(resolution.share(), 1);
  const auto seconds = [](double share) { return 0.02 + 0.48 * share * share; };
  for (int frame = 0; frame < 4; ++frame) resolution.learn(seconds(resolution.share()), resolution.share());
  EXPECT_LT(seconds(resolution.share()), 0.1);
  EXPECT_GT(seconds(resolution.share()), 0.04);
  const double found = resolution.share();
  resolution.learn(seconds(found), found);
  EXPECT_EQ(resolution.share(), found) << "it does not swing";
  for (int frame = 0; frame < 4; ++frame) resolution.learn(0.1 * seconds(resolution.share()), resolution.share());
  EXPECT_EQ(resolution.share(), 1) << "a fast driver";
  for (int frame = 0; frame < 4; ++frame) resolution.learn(10, resolution.share());
  EXPECT_GT(resolution.share(), 0.2);
  for (double full = 0.05; full < 1; full *= 1.01) {
    MovingResolution other;
    for (int frame = 0; frame < 6; ++frame) other.learn(full * other.share() * other.share(), other.share());
    EXPECT_LT(full * other.share() * other.share(), 0.1) << full;
  }
}

}  // namespace
}  // namespace lanthorn::realtime_view_test
