// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/flux_classes.h"

#include <gtest/gtest.h>

namespace lanthorn {
namespace {

TEST(FluxClasses, AreOneWithoutAReference) {
  const FluxClasses one;
  EXPECT_EQ(one.count(), 1);
  EXPECT_EQ(one.of(1e9f), 0);
  EXPECT_EQ(one.area_factor(1e9f), 1);
}

TEST(FluxClasses, HoldPhotonsWithinAFactorOfTwo) {
  const FluxClasses classes{3};
  for (int c = 0; c < classes.count(); ++c) {
    const float middle = 3 * std::ldexp(1.0f, 2 * c);
    EXPECT_EQ(classes.of(middle), c);
    EXPECT_EQ(classes.of(1.99f * middle), c);
    EXPECT_EQ(classes.of(0.501f * middle), c);
  }
  EXPECT_EQ(classes.of(0), 0);
  EXPECT_EQ(classes.of(1e30f), classes.count() - 1);
}

// Discs of class c have an area of 2^c times that of class 0; sixteen times the flux is two classes.
TEST(FluxClasses, HaveAreasThatGrowWithTheRootOfTheFlux) {
  const FluxClasses classes{3};
  EXPECT_FLOAT_EQ(FluxClasses::radius_factor(classes.of(48)), 2);
  EXPECT_FLOAT_EQ(classes.area_factor(48), 0.25f);
  EXPECT_FLOAT_EQ(classes.area_factor(1), 1);
}

}  // namespace
}  // namespace lanthorn
