// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

#include "math/primary_samples.h"

namespace lanthorn::sampler_test {
namespace {

// Each aligned run of 16 consecutive points has one point per sixteenth in each dimension, and one per 4x4 cell in the
// first two dimensions of a group: Owen scrambling and the shuffle keep (0,m,2)-nets.
TEST(Sampler, FirstDimensionsAreStratified) {
  for (const std::uint32_t pixel : {0u, 7u, 12345u}) {
    std::array<std::set<int>, 4> strata;
    std::set<std::pair<int, int>> cells;
    for (std::uint32_t pass = 32; pass < 48; ++pass) {
      Sampler sampler = Sampler::for_pixel(3, Stream::camera, pixel, pass);
      std::array<float, 4> u{};
      for (float& x : u) x = sampler.next();
      for (unsigned d = 0; d < 4; ++d) strata[d].insert(static_cast<int>(u[d] * 16));
      cells.insert({static_cast<int>(u[0] * 4), static_cast<int>(u[1] * 4)});
    }
    for (const auto& s : strata) EXPECT_EQ(s.size(), 16u);
    EXPECT_EQ(cells.size(), 16u);
  }
}

TEST(Sampler, SeekMakesDrawsAFunctionOfTheDimension) {
  Sampler a = Sampler::for_light_path(9, Stream::light, 2, 4, 77);
  std::vector<float> all(48);
  for (float& x : all) x = a.next();
  for (std::uint32_t group = 0; group < 12; ++group) {
    Sampler b = Sampler::for_light_path(9, Stream::light, 2, 4, 77);
    b.seek(group);
    EXPECT_EQ(b.next(), all[4 * group]);
    EXPECT_EQ(b.next2(), Vec2(all[4 * group + 1], all[4 * group + 2]));
  }
}

// Drawing groups ahead of time, or drawing a neighbouring group, changes no numbers.
TEST(Sampler, DrawingAheadChangesNoNumber) {
  PrimarySamples chain(0.01f);
  chain.start(5);
  for (const bool of_chain : {false, true}) {
    const auto fresh = [&] { return of_chain ? Sampler(chain) : Sampler::for_pixel(9, Stream::camera, 77, 4); };
    Sampler often = fresh();
    for (const std::uint32_t group : {2u, 3u, 1u, 0u, 7u, 8u, 9u, 2u, 2u}) {
      Sampler once = fresh();
      once.seek(group);
      if (group % 3 != 0) often.draw_ahead(group);
      often.seek(group);
      for (int i = 0; i < 11; ++i) EXPECT_EQ(often.next(), once.next()) << group << " " << i;
    }
  }
}

// Means are 1/2, and covariances between dimensions, groups and streams are 0, within 4.5 standard errors of
// independent draws (false alarms: < 1e-4 in all; low-discrepancy dimensions are only closer).
TEST(Sampler, DimensionsAreUniformAndUncorrelated) {
  constexpr int n = 1 << 14, dims = 40;
  std::vector<double> mean(dims), product(dims);
  for (int i = 0; i < n; ++i) {
    Sampler s = Sampler::for_pixel(1, Stream::camera, static_cast<std::uint32_t>(i), 5);
    double previous = 0.5;
    for (unsigned d = 0; d < dims; ++d) {
      const double x = s.next();
      ASSERT_GE(x, 0);
      ASSERT_LT(x, 1);
      mean[d] += x / n;
      product[d] += (x - 0.5) * (previous - 0.5) / n;
      previous = x;
    }
  }
  for (unsigned d = 0; d < dims; ++d) {
    EXPECT_NEAR(mean[d], 0.5, 4.5 * std::sqrt(1.0 / 12 / n));
    if (d == 0) continue;
    EXPECT_NEAR(product[d], 0, 4.5 / 12 / std::sqrt(n));
  }
}

}  // namespace
}  // namespace lanthorn::sampler_test
