// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/sampling.h"

#include <gtest/gtest.h>

#include <limits>

namespace lanthorn::power_heuristic_test {
namespace {

TEST(PowerHeuristic, WeighsBySquares) {
  EXPECT_FLOAT_EQ(power_heuristic(1, 1), 0.5f);
  EXPECT_FLOAT_EQ(power_heuristic(3, 1), 0.9f);
  EXPECT_FLOAT_EQ(power_heuristic(1, 3), 0.1f);
  EXPECT_EQ(power_heuristic(2, 0), 1);
  EXPECT_EQ(power_heuristic(0, 2), 0);
}

TEST(PowerHeuristic, WeightsOfBothTechniquesSumToOne) {
  for (const float other : {1e-30f, 1e-3f, 0.7f, 1.0f, 40.0f, 1e30f})
    EXPECT_FLOAT_EQ(power_heuristic(0.7f, other) + power_heuristic(other, 0.7f), 1);
}

TEST(PowerHeuristic, DensitiesWhoseSquaresOverflow) {
  EXPECT_FLOAT_EQ(power_heuristic(3e30f, 1e30f), 0.9f);
  EXPECT_FLOAT_EQ(power_heuristic(1e30f, 3e30f), 0.1f);
  EXPECT_EQ(power_heuristic(1, std::numeric_limits<float>::infinity()), 0);
}

}  // namespace
}  // namespace lanthorn::power_heuristic_test
