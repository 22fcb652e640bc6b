// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/realtime_view.h"

#include <gtest/gtest.h>

namespace lanthorn::realtime_view_test {
namespace {

FrameReport with_eye_paths(double milliseconds) {
  FrameReport report;
  report.stages = {{"direct light", 500}, {eye_path_stage, milliseconds}};
  return report;
}

// A processor that takes 900 ms for a path in each pixel: the spacing is found in a frame, stays, and goes back when
// few pixels need paths.
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

}  // namespace
}  // namespace lanthorn::realtime_view_test
