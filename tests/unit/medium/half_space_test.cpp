// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The reflectance of half-spaces against Chandrasekhar's exact solution and against random walks.
#include "medium/half_space.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "math/hash.h"
#include "math/sampling.h"
#include "medium/medium.h"
#include "surface/fresnel.h"

namespace lanthorn::half_space_test {
namespace {

// Isotropic scattering without an interface (Chandrasekhar 1960, "Radiative Transfer", sections 33 and 38): light from
// the direction μ is reflected by 1 - √(1 - a) H(μ), with 1 / H(μ) = √(1 - a) + a/2 ∫ μ' H(μ') / (μ + μ') dμ'.
double chandrasekhar(double a) {
  constexpr std::size_t steps = 400;
  std::array<double, steps> h{};
  h.fill(1);
  const auto mu = [](std::size_t i) { return (static_cast<double>(i) + 0.5) / steps; };
  for (int iteration = 0; iteration < 200; ++iteration) {
    std::array<double, steps> next{};
    for (std::size_t i = 0; i < steps; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < steps; ++j) sum += mu(j) * h[j] / (mu(i) + mu(j)) / steps;
      next[i] = 1 / (std::sqrt(1 - a) + a / 2 * sum);
    }
    h = next;
  }
  double moment = 0;
  for (std::size_t i = 0; i < steps; ++i) moment += mu(i) * h[i] / steps;
  return 1 - 2 * std::sqrt(1 - a) * moment;
}

TEST(HalfSpace, IsExactForIsotropicScattering) {
  for (const double a : {0.1, 0.5, 0.9, 0.99, 0.999})
    EXPECT_NEAR(half_space_reflectance(a, 0, 1), chandrasekhar(a), 2e-4) << a;
}

// The end of a walk that begins with a refracted ray of an even sky: whether it leaves the half-space z < 0.
bool walk_leaves(HashRng& rng, float albedo, const HenyeyGreenstein& phase, float eta) {
  std::optional<float> inside;  // cosine of the refracted ray
  while (!inside) {
    const float outside = std::sqrt(rng.next());  // cosine-weighted
    const DielectricFresnel fresnel = fresnel_dielectric(outside, eta);
    if (rng.next() >= fresnel.reflectance) inside = fresnel.cos_t;
  }
  Direction direction(std::sqrt(1 - *inside * *inside), 0, -*inside);
  float z = 0;
  for (;;) {
    const float distance = -std::log(1 - rng.next());
    z += distance * direction.z;
    if (z < 0) {
      if (rng.next() >= albedo) return false;
      direction = sample_phase(phase, -direction, rng.next2()).wo;
      continue;
    }
    if (rng.next() >= fresnel_dielectric(direction.z, 1 / eta).reflectance) return true;
    direction.z = -direction.z;
    z = 0;  // flights have no memory: a new one begins at the interface
  }
}

class HalfSpaceWalks : public testing::TestWithParam<float> {};

// 5.5 standard errors: 24 checks fail by chance at a rate below 1e-6.
TEST_P(HalfSpaceWalks, AgreeWithReflectance) {
  const float eta = GetParam();
  constexpr int walks = 20'000;
  HashRng rng(7);
  for (const float g : {0.0f, 0.7f, -0.4f})
    for (const float albedo : {0.5f, 0.95f}) {
      int left = 0;
      for (int i = 0; i < walks; ++i) left += walk_leaves(rng, albedo, {g}, eta) ? 1 : 0;
      const double expected =
          half_space_reflectance(static_cast<double>(albedo), static_cast<double>(g), static_cast<double>(eta));
      const double error = std::sqrt(expected * (1 - expected) / walks);
      EXPECT_NEAR(static_cast<double>(left) / walks, expected, 5.5 * error) << g << ' ' << albedo;
    }
}
INSTANTIATE_TEST_SUITE_P(Indices, HalfSpaceWalks, testing::Values(0.8f, 1.0f, 1.33f, 1.8f));

// All light comes back from a medium that absorbs nothing, and none from one that scatters nothing.
TEST(HalfSpace, HasLimits) {
  for (const double eta : {0.7, 1.0, 1.33, 2.5})
    for (const double g : {-0.6, 0.0, 0.9}) {
      EXPECT_NEAR(half_space_reflectance(1, g, eta), 1, 2e-4);
      EXPECT_EQ(half_space_reflectance(0, g, eta), 0);
      EXPECT_EQ(half_space_albedo(0, g, eta), 0);
      EXPECT_EQ(half_space_albedo(1, g, eta), 1);
      EXPECT_EQ(half_space_albedo(1.5, g, eta), 1);
      EXPECT_EQ(half_space_albedo(-1, g, eta), 0);
      for (const double reflectance : {0.01, 0.2, 0.5, 0.9, 0.99})
        EXPECT_NEAR(half_space_reflectance(half_space_albedo(reflectance, g, eta), g, eta), reflectance, 2e-5);
    }
}

}  // namespace
}  // namespace lanthorn::half_space_test
