// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/hash.h"

namespace lanthorn::noise_test {
namespace {

Point random_point(HashRng& rng, float size) {
  const float x = rng.next(), y = rng.next(), z = rng.next();
  return size * (2.0f * Vec3(x, y, z) - 1.0f);
}

// The gradient, by central differences.
Vec3 slope(const Point& p) {
  constexpr float h = 1e-2f;
  Vec3 g;
  for (int i = 0; i < 3; ++i) {
    Vec3 step(0);
    step[i] = h;
    g[i] = (perlin_noise(p + step) - perlin_noise(p - step)) / (2 * h);
  }
  return g;
}

// The value that Perlin's reference implementation returns, at a point where both have the same gradients.
TEST(Noise, IsPerlins) { EXPECT_NEAR(perlin_noise({3.14f, 42, 7}), 0.13691995878400012, 1e-6); }

TEST(Noise, IsZeroOnTheLatticeWithEdgesAsGradients) {
  HashRng rng(1);
  int seen[3] = {0, 0, 0};
  for (int i = 0; i < 500; ++i) {
    const Point p = floor(random_point(rng, 300));
    EXPECT_EQ(perlin_noise(p), 0);
    const Vec3 g = slope(p);
    int zeros = 0;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(std::fabs(g[axis]), std::round(std::fabs(g[axis])), 5e-3);
      if (std::fabs(g[axis]) < 0.5f) {
        ++zeros;
        ++seen[axis];
      }
    }
    EXPECT_EQ(zeros, 1);
  }
  // x is zero in 6 of 16 gradients, y in 4 and z in 6, so of 500 about 125 at least. 60 is almost seven standard
  // deviations less.
  for (const int count : seen) EXPECT_GT(count, 60);
}

TEST(Noise, HasPeriod256AndContinuousSlopesAcrossCells) {
  HashRng rng(2);
  for (int i = 0; i < 200; ++i) {
    const Point p = random_point(rng, 100);
    // Multiples of 2^-10 are exact after the shift.
    const Point q = floor(p * 1024.0f) / 1024.0f;
    EXPECT_EQ(perlin_noise(q), perlin_noise(q + Vec3(256, -512, 256)));
    Point border = q;
    border[i % 3] = std::floor(border[i % 3]);
    Point before = border, after = border;
    before[i % 3] -= 0.03f;
    after[i % 3] += 0.03f;
    EXPECT_NEAR(perlin_noise(before), perlin_noise(after), 0.2f);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(slope(before)[axis], slope(after)[axis], 0.25f);
  }
  for (const float bad : {NAN, INFINITY, -INFINITY}) EXPECT_EQ(perlin_noise({0.5f, bad, 0.5f}), 0);
  EXPECT_TRUE(std::isfinite(perlin_noise({1e30f, -3e38f, 1e20f})));
}

// With 4e5 points in 8e6 cells, the standard error of the mean is below 5e-4.
TEST(Noise, HasMeanZeroAndStaysInRange) {
  HashRng rng(3);
  double sum = 0, squares = 0;
  float largest = 0;
  constexpr int n = 400000;
  for (int i = 0; i < n; ++i) {
    const float v = perlin_noise(random_point(rng, 100));
    sum += v;
    squares += sqr(static_cast<double>(v));
    largest = std::max(largest, std::fabs(v));
  }
  EXPECT_NEAR(sum / n, 0, 2.5e-3);
  EXPECT_LT(largest, 1.04f);
  EXPECT_GT(largest, 0.7f);
  EXPECT_GT(squares / n, 0.05);
}

TEST(Noise, OctavesAddUp) {
  HashRng rng(4);
  for (int i = 0; i < 100; ++i) {
    const Point p = random_point(rng, 10);
    EXPECT_EQ(fbm(p, 0.3f, 1), perlin_noise(p));
    EXPECT_EQ(turbulence(p, 0.3f, 1), std::fabs(perlin_noise(p)));
    double sum = 0, absolute = 0;
    for (int k = 0; k < 4; ++k) {
      const auto frequency = static_cast<float>(std::pow(1.99, k));
      sum += std::pow(0.6, k) * perlin_noise(frequency * p);
      absolute += std::pow(0.6, k) * std::fabs(perlin_noise(frequency * p));
    }
    EXPECT_NEAR(fbm(p, 0.6f, 4), sum, 1e-4);
    EXPECT_NEAR(turbulence(p, 0.6f, 4), absolute, 1e-4);
  }
}

}  // namespace
}  // namespace lanthorn::noise_test
