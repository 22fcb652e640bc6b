// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/bilinear_distribution.h"

#include <gtest/gtest.h>

#include "math/hash.h"
#include "support/chi2.h"
#include "support/jacobian.h"

namespace lanthorn::bilinear_distribution_test {
namespace {

constexpr std::size_t width = 5, height = 4;

// Two densities. The first has a row and a corner of zeros.
std::vector<float> two_grids() {
  std::vector<float> values{0, 0, 0, 0, 0, 0, 3, 1, 2, 5, 1, 1, 8, 0, 0, 2, 1, 1, 0, 0};
  for (std::size_t i = 0; i < width * height; ++i) values.push_back(1 + 0.3f * static_cast<float>(i % 7));
  return values;
}

const std::vector<Blend>& blends() {
  static const std::vector<Blend> all{
      {{0, 0, 0, 0}, {1, 0, 0, 0}}, {{1, 0, 0, 0}, {1, 0, 0, 0}}, {{0, 1, 0, 1}, {0.25f, 0.5f, 0.125f, 0.125f}}};
  return all;
}

TEST(BilinearDistributions, DensityIsTheNormalizedBlend) {
  const BilinearDistributions d(two_grids(), width, height);
  for (const Blend& blend : blends()) {
    double sum = 0;
    const int n = 240;  // divisible by both cell counts, so the midpoint rule is exact for the linear pieces
    for (int i = 0; i < n * n; ++i)
      sum += static_cast<double>(
          d.pdf((Vec2(static_cast<float>(i % n), static_cast<float>(i / n)) + Vec2(0.5f)) / float{n}, blend));
    EXPECT_NEAR(sum / (n * n), 1, 1e-4);
  }
  // At the nodes, densities have the ratios of the table, and a blend weights both densities.
  const Vec2 a(0.25f, 1.0f / 3), b(1, 1.0f / 3);
  EXPECT_NEAR(d.pdf(a, blends()[0]) / d.pdf(b, blends()[0]), 3.0f / 5, 1e-5f);
  EXPECT_NEAR(d.pdf(a, blends()[2]), 0.375f * d.pdf(a, blends()[0]) + 0.625f * d.pdf(a, blends()[1]), 1e-5f);
}

TEST(BilinearDistributions, InvertUndoesSample) {
  const BilinearDistributions d(two_grids(), width, height);
  HashRng rng(1);
  for (const Blend& blend : blends()) {
    for (int i = 0; i < 2000; ++i) {
      const Vec2 u = rng.next2();
      const auto s = d.sample(u, blend);
      ASSERT_GT(s.pdf, 0);
      EXPECT_NEAR(s.pdf, d.pdf(s.at, blend), 1e-3f * s.pdf);
      const auto back = d.invert(s.at, blend);
      EXPECT_NEAR(back.at.x, u.x, 1e-4f);
      EXPECT_NEAR(back.at.y, u.y, 1e-4f);
      EXPECT_NEAR(back.pdf, s.pdf, 1e-3f * s.pdf);
    }
  }
}

TEST(BilinearDistributions, SamplesStretchTheSquareByTheDensity) {
  const BilinearDistributions d(two_grids(), width, height);
  for (const Blend& blend : blends()) {
    const test::DirectionSampler sampler{[&](float, const Vec2& u) { return std::optional(d.sample(u, blend).at); },
                                         [&](const Vec2& at) { return d.pdf(at, blend); }};
    EXPECT_TRUE(test::jacobian_test(sampler, {.points = 1000, .step = 1e-3f, .tolerance = 0.02, .share = 0.9}));
  }
}

TEST(BilinearDistributions, EdgesStayInTheSquare) {
  const BilinearDistributions d(two_grids(), width, height);
  for (const Blend& blend : blends())
    for (const Vec2& u : {Vec2(0), Vec2(one_minus_epsilon), Vec2(0, one_minus_epsilon), Vec2(one_minus_epsilon, 0)}) {
      const auto s = d.sample(u, blend);
      EXPECT_TRUE(s.at.x >= 0 && s.at.x <= 1 && s.at.y >= 0 && s.at.y <= 1);
      EXPECT_GE(s.pdf, 0);
    }
}

}  // namespace
}  // namespace lanthorn::bilinear_distribution_test
