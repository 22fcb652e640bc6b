// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Phase function and flights against integrals. Monte Carlo means: fixed seeds, bounds at 5 standard errors (false-alarm
// rate below 1e-6 each).
#include <gtest/gtest.h>

#include <cmath>

#include "medium/medium.h"

namespace lanthorn {
namespace {

const Wavelengths rgb = Wavelengths::rgb(0.5f);

struct Mean {
  double sum = 0, squares = 0;
  int count = 0;

  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double mean() const { return sum / count; }
  double error() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean()) / count) + 1e-7; }
};

class Phase : public testing::TestWithParam<float> {};

TEST_P(Phase, IsNormalisedWithMeanCosineG) {
  const HenyeyGreenstein hg{GetParam()};
  const Direction wi(0, 0, 1);
  double total = 0, mean_cosine = 0;
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const float z = -1 + 2 * (static_cast<float>(i) + 0.5f) / steps;
    const float p = phase(hg, wi, {std::sqrt(1 - z * z), 0, z});
    total += 4.0 * static_cast<double>(pi) / steps * static_cast<double>(p);
    mean_cosine += 4.0 * static_cast<double>(pi) / steps * static_cast<double>(p * -z);
  }
  EXPECT_NEAR(total, 1, 1e-3);
  EXPECT_NEAR(mean_cosine, static_cast<double>(GetParam()), 1e-3);
}

// Moments of the cosine under sampling, against those of the density; and the density that comes with the sample.
TEST_P(Phase, SamplesFollowIt) {
  const HenyeyGreenstein hg{GetParam()};
  const Direction wi = normalize(Vec3(1, -2, 0.5f));
  HashRng rng(1);
  Mean cosine, side;
  for (int i = 0; i < 100'000; ++i) {
    const PhaseSample s = sample_phase(hg, wi, rng.next2());
    ASSERT_NEAR(length_squared(s.wo), 1, 1e-5);
    ASSERT_NEAR(s.pdf, phase(hg, wi, s.wo), 1e-6f + 1e-4f * s.pdf);
    cosine.add(static_cast<double>(dot(-wi, s.wo)));
    side.add(static_cast<double>(dot(s.wo, normalize(cross(wi, Vec3(0, 0, 1))))));
  }
  EXPECT_NEAR(cosine.mean(), static_cast<double>(GetParam()), 5 * cosine.error());
  EXPECT_NEAR(side.mean(), 0, 5 * side.error());
}
INSTANTIATE_TEST_SUITE_P(Asymmetries, Phase, testing::Values(-0.6f, 0.0f, 0.0005f, 0.3f, 0.9f));

HomogeneousMedium chromatic() {
  HomogeneousMedium m;
  m.sigma_a = SpectrumCurve::unbounded({0.1f, 0.5f, 2.0f});
  m.sigma_s = SpectrumCurve::unbounded({0.2f, 1.0f, 6.0f});
  return m;
}

// What gets through, and what scatters before each of some distances, in every channel.
TEST(Homogeneous, FlightsAreUnbiased) {
  const HomogeneousMedium m = chromatic();
  constexpr float length = 0.8f;
  const Spectrum beta(0.2f, 1.0f, 0.5f, 0);
  const Spectrum a = m.sigma_a.evaluate(rgb), s = m.sigma_s.evaluate(rgb), t = a + s;
  std::array<Mean, 3> through, early, late;
  HashRng rng(2);
  for (int i = 0; i < 200'000; ++i) {
    const Flight f = m.fly(length, beta, rgb, rng);
    for (unsigned c = 0; c < 3; ++c) {
      const double weight = static_cast<double>(f.weight[static_cast<int>(c)]);
      through[c].add(f.distance ? 0 : weight);
      early[c].add(f.distance && *f.distance < 0.3f ? weight : 0);
      late[c].add(f.distance && *f.distance >= 0.3f ? weight : 0);
      if (f.distance) {
        ASSERT_LT(*f.distance, length);
      }
    }
  }
  for (unsigned c = 0; c < 3; ++c) {
    const double sigma_t = static_cast<double>(t[static_cast<int>(c)]);
    const double albedo = static_cast<double>(s[static_cast<int>(c)]) / sigma_t;
    const double at_split = std::exp(-sigma_t * 0.3), at_end = std::exp(-sigma_t * static_cast<double>(length));
    EXPECT_NEAR(through[c].mean(), at_end, 5 * through[c].error()) << c;
    EXPECT_NEAR(early[c].mean(), albedo * (1 - at_split), 5 * early[c].error()) << c;
    EXPECT_NEAR(late[c].mean(), albedo * (at_split - at_end), 5 * late[c].error()) << c;
  }
}

TEST(Homogeneous, AbsorbersAreExact) {
  HomogeneousMedium m = chromatic();
  m.sigma_s = SpectrumCurve::constant(0);
  HashRng rng(3);
  const Flight f = m.fly(2, Spectrum(1, 1, 1, 0), rgb, rng);
  EXPECT_FALSE(f.distance);
  EXPECT_NEAR(f.weight[1], std::exp(-1.0f), 1e-6f);
  EXPECT_EQ(f.weight[1], m.transmittance(2, rgb)[1]);
}

TEST(Homogeneous, InfiniteSegmentsEnd) {
  HomogeneousMedium m = chromatic();
  EXPECT_EQ(m.transmittance(infinity, rgb)[0], 0);
  m.sigma_s = m.sigma_a = SpectrumCurve::constant(0);
  EXPECT_EQ(m.transmittance(infinity, rgb)[0], 1);
  HashRng rng(4);
  EXPECT_EQ(m.fly(infinity, Spectrum(1), rgb, rng).weight[0], 1);
  EXPECT_TRUE(chromatic().fly(infinity, Spectrum(1, 0, 0, 0), rgb, rng).distance);
}

// An infinitely deep glowing medium without scattering has its emission as radiance; a thin one sigma_a L_e length.
TEST(Homogeneous, GlowIsTheEmissionIntegral) {
  HomogeneousMedium m = chromatic();
  m.emission = SpectrumCurve::constant(3);
  m.sigma_s = SpectrumCurve::constant(0);
  HashRng rng(5);
  EXPECT_NEAR(m.fly(infinity, Spectrum(1), rgb, rng).glow[1], 3, 1e-5);
  EXPECT_NEAR(m.fly(0.01f, Spectrum(1), rgb, rng).glow[1], 3 * (1 - std::exp(-0.005)), 1e-5);
}

}  // namespace
}  // namespace lanthorn
