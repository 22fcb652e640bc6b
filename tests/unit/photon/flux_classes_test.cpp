// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/flux_classes.h"

#include <gtest/gtest.h>

#include "math/vec.h"

namespace lanthorn::flux_classes_test {
namespace {

TEST(FluxClasses, AreOneWithoutAReference) {
  const FluxClasses one;
  EXPECT_EQ(one.count(), 1);
  EXPECT_EQ(one.of(1e9f), 0);
  EXPECT_EQ(one.area_factor(1e9f), 1);
}

TEST(FluxClasses, HoldPhotonsWithinAFactorOfFour) {
  const FluxClasses classes{3};
  for (int c = 0; c < classes.count(); ++c) {
    const float middle = 3 * std::ldexp(1.0f, 4 * c);
    EXPECT_EQ(classes.of(middle), c);
    EXPECT_EQ(classes.of(3.99f * middle), c);
    EXPECT_EQ(classes.of(0.251f * middle), c);
  }
  EXPECT_EQ(classes.of(0), 0);
  EXPECT_EQ(classes.of(1e30f), classes.count() - 1);
  EXPECT_EQ(classes.of(infinity), classes.count() - 1);
}

// Photons of sixteen times the flux form a class, with four times the area.
TEST(FluxClasses, HaveAreasThatGrowWithTheRootOfTheFlux) {
  const FluxClasses classes{3};
  EXPECT_FLOAT_EQ(FluxClasses::radius_factor(classes.of(48)), 2);
  EXPECT_FLOAT_EQ(classes.area_factor(48), 0.25f);
  EXPECT_FLOAT_EQ(classes.area_factor(1), 1);
}

// For a dispersed path, only the first wavelength matters, whatever flux the other wavelengths carry.
TEST(FluxClasses, CountWhatDispersionLeaves) {
  const Wavelengths w = Wavelengths::spectral(0.3f);
  EXPECT_FLOAT_EQ(flux_of({1, 2, 3, 4}, false, w), 10);
  EXPECT_FLOAT_EQ(flux_of({1, 2, 3, 4}, true, w), 4);
}

}  // namespace
}  // namespace lanthorn::flux_classes_test
