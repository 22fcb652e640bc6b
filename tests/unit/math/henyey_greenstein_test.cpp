// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/henyey_greenstein.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/hash.h"

namespace lanthorn::henyey_greenstein_test {
namespace {

// Asymmetries g. -g is tested as well, which gives the mirror image.
class Peaks : public testing::TestWithParam<float> {};

// The integrals are over log(1 - cos), because most of a narrow peak lies where 1 - cos is below (1 - g)^2.
TEST_P(Peaks, AreNormalisedAndHaveTheirMeanCosine) {
  const float g = GetParam();
  const double expected = 1 - static_cast<double>(g);
  double total = 0, mean_versine = 0;
  constexpr int steps = 100'000;
  const double low = std::log(1e-20), high = std::log(2.0);
  for (int i = 0; i < steps; ++i) {
    const double versine = std::exp(low + (high - low) * (i + 0.5) / steps);
    const double density = static_cast<double>(henyey_greenstein(g, static_cast<float>(versine)));
    const double mass = 2 * static_cast<double>(pi) * density * versine * (high - low) / steps;
    total += mass;
    mean_versine += mass * versine;
  }
  EXPECT_NEAR(total, 1, 1e-4);
  EXPECT_NEAR(mean_versine, expected, 1e-4 * expected);
}

// Half of the samples lie within the median angle. The density returned with a direction equals the density evaluated
// for it, up to the direction's own rounding.
TEST_P(Peaks, AreSampled) {
  const Direction in = normalize(Vec3(1, -2, 0.5f));
  for (const float g : {GetParam(), -GetParam()}) {
    const Direction peak = g < 0 ? -in : in;
    const float rest = 1 - std::fabs(g);
    const double s = static_cast<double>(rest) * (1 + static_cast<double>(std::fabs(g)));  // for u = 1/2: 1 + g - g = 1
    const double median = (s * s - static_cast<double>(rest * rest)) / (2 * static_cast<double>(std::fabs(g)));
    HashRng rng(1);
    int within = 0;
    constexpr int count = 100'000;
    for (int i = 0; i < count; ++i) {
      const SampledScattering sampled = sample_henyey_greenstein(g, in, rng.next2());
      ASSERT_NEAR(length_squared(sampled.out), 1, 1e-5);
      const float versine = versine_between(peak, sampled.out), rounding = 4e-7f / std::fmax(rest, std::sqrt(versine));
      ASSERT_NEAR(sampled.pdf, henyey_greenstein(g, in, sampled.out), (1e-4f + rounding) * sampled.pdf) << g;
      within += static_cast<double>(versine) < median ? 1 : 0;
    }
    EXPECT_NEAR(within, count / 2, 5 * std::sqrt(count / 4.0)) << g;
  }
}

INSTANTIATE_TEST_SUITE_P(Asymmetries, Peaks, testing::Values(0.1f, 0.9f, 0.9999f, 0.99999f));

}  // namespace
}  // namespace lanthorn::henyey_greenstein_test
