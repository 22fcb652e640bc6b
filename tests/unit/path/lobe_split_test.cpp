// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/lobe_split.h"

#include <gtest/gtest.h>

#include "math/sampler.h"
#include "support/statistics.h"
#include "surface/bsdf.h"

namespace lanthorn::lobe_split_test {
namespace {

// Fraction of a metal's light, at normal incidence, that is left to the cache.
double wide_part(float alpha) {
  const Bsdf metal = Conductor{.eta = Spectrum(0.2f), .k = Spectrum(3), .alpha_x = alpha, .alpha_y = alpha};
  test::Mean part, light;
  HashRng rng(test::seed(3));
  for (int i = 0; i < 100'000; ++i) {
    const auto s = sample(metal, {0, 0, 1}, 0, rng.next2(), Transport::radiance);
    if (!s) continue;
    part.add(static_cast<double>(s->weight[0] * LobeSplit().wide(s->pdf)));
    light.add(static_cast<double>(s->weight[0]));
  }
  return part.mean() / light.mean();
}

TEST(LobeSplit, FollowsTheWidthOfLobes) {
  // Half of a lobe of half_spread_alpha, plus the light at densities that diffuse surfaces have as well.
  EXPECT_NEAR(wide_part(half_spread_alpha), 0.55, 0.02);
  EXPECT_GT(wide_part(0.3f), 0.9);
  EXPECT_LT(wide_part(0.01f), 0.1);
}

TEST(LobeSplit, BoundsWhatTheCacheCounts) {
  const LobeSplit split;
  EXPECT_EQ(split.wide(inv_pi), 1);
  EXPECT_EQ(split.narrow(infinity), 1);
  float last = 1;
  for (float pdf = 0.01f; pdf < 1e9f; pdf *= 2) {
    EXPECT_LE(split.wide(pdf), last);
    EXPECT_LT(split.wide(pdf) * pdf, 2);  // h + 1 / pi
    EXPECT_FLOAT_EQ(split.wide(pdf) + split.narrow(pdf), 1);
    last = split.wide(pdf);
  }
}

TEST(LobeSplit, LeavesAllToOne) {
  for (const float pdf : {0.0f, 1.0f, 1e6f, infinity}) {
    EXPECT_EQ(LobeSplit::all_wide().wide(pdf), 1);
    EXPECT_EQ(LobeSplit::all_narrow().narrow(pdf), 1);
  }
  EXPECT_TRUE(LobeSplit::all_wide().is_all_wide() && !LobeSplit::all_wide().is_all_narrow());
  EXPECT_TRUE(LobeSplit::all_narrow().is_all_narrow() && !LobeSplit::all_narrow().is_all_wide());
  EXPECT_FALSE(LobeSplit().is_all_wide() || LobeSplit().is_all_narrow());
}

}  // namespace
}  // namespace lanthorn::lobe_split_test
