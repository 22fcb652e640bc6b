// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>

#include "lanthorn/session.h"
#include "render/state.h"

namespace lanthorn::progress_test {
namespace {

constexpr std::uint64_t endless = 0xffffffff;

RenderState state_of(PassRange passes) {
  RenderState state;
  state.passes = {passes};
  return state;
}

RenderStatistics statistics_of(std::uint64_t passes, double seconds) {
  RenderStatistics statistics;
  statistics.passes = passes;
  statistics.seconds = seconds;
  return statistics;
}

// An estimate of noise without bias; noise falls as 1/sqrt(n).
ErrorEstimate noise(double bound) { return {.noise = bound, .bias = 0, .error = bound, .bound = bound, .doubt = ""}; }

TEST(Progress, OfPassesCountsThoseOfThisCall) {
  const RenderProgress progress = progress_of({.passes = {0, 20}}, state_of({0, 11}), statistics_of(3, 6));
  EXPECT_EQ(progress.passes_left, 9u);
  EXPECT_DOUBLE_EQ(progress.fraction, 0.25);
  EXPECT_DOUBLE_EQ(progress.seconds_left.value(), 18);
}

TEST(Progress, OfAnEndlessRenderIsNotKnown) {
  const RenderProgress progress = progress_of({.passes = {0, endless}}, state_of({0, 3}), statistics_of(3, 6));
  EXPECT_FALSE(progress.passes_left);
  EXPECT_FALSE(progress.seconds_left);
  EXPECT_EQ(progress.fraction, 0);
}

TEST(Progress, OfTimeIsTheTimeThatIsLeft) {
  const RenderProgress progress =
      progress_of({.passes = {0, endless}, .seconds = 40}, state_of({0, 3}), statistics_of(3, 10));
  EXPECT_DOUBLE_EQ(progress.seconds_left.value(), 30);
}

// After 8 passes, the error is twice the bound: 32 passes are needed. This call has completed the last 10 of 12.
TEST(Progress, OfABoundIsByThePassesThatItNeeds) {
  const StopRule stop{.passes = {0, endless}, .noise = 0.1};
  RenderStatistics statistics = statistics_of(10, 5);
  EXPECT_FALSE(progress_of(stop, state_of({0, 12}), statistics).seconds_left);
  statistics.error = noise(0.2);
  statistics.error_passes = 8;
  EXPECT_NEAR(progress_of(stop, state_of({0, 12}), statistics).seconds_left.value(), 10, 1e-6);
  statistics.error->doubt = "there are too few passes";
  EXPECT_FALSE(progress_of(stop, state_of({0, 12}), statistics).seconds_left);
  statistics.error = noise(0.09);
  EXPECT_EQ(progress_of(stop, state_of({0, 12}), statistics).seconds_left, 0);
}

// Every render knows its error, but only a requested bound ends it.
TEST(Progress, WithoutABoundTheErrorEndsNothing) {
  RenderStatistics statistics = statistics_of(10, 5);
  statistics.error = noise(0.2);
  statistics.error_passes = 10;
  EXPECT_FALSE(progress_of({.passes = {0, endless}}, state_of({0, 10}), statistics).seconds_left);
}

TEST(Progress, WhateverComesFirstCounts) {
  const StopRule stop{.passes = {0, 40}, .seconds = 20};
  EXPECT_DOUBLE_EQ(progress_of(stop, state_of({0, 10}), statistics_of(10, 10)).seconds_left.value(), 10);
  EXPECT_DOUBLE_EQ(progress_of(stop, state_of({0, 30}), statistics_of(30, 10)).seconds_left.value(), 10.0 / 3);
}

}  // namespace
}  // namespace lanthorn::progress_test
