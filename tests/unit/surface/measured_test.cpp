// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A table made from a GGX conductor must behave like that conductor.
#include "surface/measured.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "math/hash.h"
#include "math/sampling.h"
#include "spectrum/curve.h"
#include "support/bsdf_sampler.h"
#include "support/measured_conductor.h"
#include "surface/bsdf.h"

namespace lanthorn::measured_test {
namespace {

using test::at_angles;
using test::measure;
using test::MeasuredConductor;

const std::vector<test::MetalIndex> gold{{0.143f, 3.98f}, {0.374f, 2.39f}, {1.442f, 1.60f}};
const Wavelengths rgb = Wavelengths::rgb(0.5f);

Conductor gold_of(const MeasuredConductor& c) {
  return {Spectrum(0.143f, 0.374f, 1.442f, 0), Spectrum(3.98f, 2.39f, 1.60f, 0), c.alpha_x, c.alpha_y};
}

/// Mean relative difference from the conductor, over directions sampled from the conductor.
double mean_difference(const Bsdf& measured, const Bsdf& conductor, int component) {
  HashRng rng(1);
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 4000; ++i) {
    // The measurement reaches 1.5 radians; this keeps some distance from the horizon.
    Vec3 wi = sample_cosine_hemisphere(rng.next2());
    if (wi.z < 0.2f) continue;
    if (i % 2 == 1) wi = -wi;
    const auto s = sample(conductor, wi, rng.next(), rng.next2(), Transport::radiance);
    if (!s || std::fabs(s->wo.z) < 0.1f) continue;
    const float expected = evaluate(conductor, wi, s->wo, Transport::radiance).f[component];
    const float found = evaluate(measured, wi, s->wo, Transport::radiance).f[component];
    sum += static_cast<double>(std::fabs(found / expected - 1));
    ++count;
  }
  EXPECT_GT(count, 2000);
  return sum / count;
}

TEST(Measured, IsCloseToWhatItWasMadeFrom) {
  for (const MeasuredConductor& c :
       {MeasuredConductor{.alpha_x = 0.2f, .alpha_y = 0.2f, .indices = gold},
        MeasuredConductor{.alpha_x = 0.5f, .alpha_y = 0.5f, .indices = gold},
        MeasuredConductor{.alpha_x = 0.6f, .alpha_y = 0.25f, .indices = gold},
        MeasuredConductor{.alpha_x = 0.6f, .alpha_y = 0.25f, .indices = gold, .azimuths = 5, .symmetry = 4}}) {
    const MeasuredData data = measure(c);
    const MeasuredBrdf brdf(data);
    for (int component = 0; component < 3; ++component)
      EXPECT_LT(mean_difference(Measured{&brdf, rgb}, gold_of(c), component), 0.03)
          << c.alpha_x << ' ' << c.alpha_y << " symmetry " << c.symmetry;
    EXPECT_NEAR(brdf.alpha(), std::sqrt(c.alpha_x * c.alpha_y), 0.02f);
  }
}

TEST(Measured, SpectraAreThoseOfTheWavelengths) {
  const DenseSpectrum *eta = named_spectrum("metal-Au-eta"), *k = named_spectrum("metal-Au-k");
  MeasuredConductor c;
  for (float nm = 350; nm < 840; nm += 10) {
    c.wavelengths.push_back(nm);
    const float inside = std::fmax(nm, lambda_min);
    c.indices.push_back({eta->at(std::fmin(inside, lambda_max)), k->at(std::fmin(inside, lambda_max))});
  }
  const MeasuredData data = measure(c);
  const MeasuredBrdf brdf(data);
  for (const float u : {0.1f, 0.6f}) {
    const Wavelengths w = Wavelengths::spectral(u);
    Conductor conductor{{}, {}, c.alpha_x, c.alpha_y};
    for (unsigned i = 0; i < 4; ++i) {
      conductor.eta.v[i] = eta->at(w.lambda[i]);
      conductor.k.v[i] = k->at(w.lambda[i]);
    }
    for (int component = 0; component < 4; ++component)
      EXPECT_LT(mean_difference(Measured{&brdf, w}, conductor, component), 0.03)
          << w.lambda[static_cast<unsigned>(component)];
  }
  // In RGB mode, the value is the mean of the reflectance at each wavelength, weighted by the response of Rec.709.
  const Vec3 wi = at_angles(30, 0), wo = at_angles(25, 170);
  Rgb mean{};
  for (std::size_t i = 0; i < c.wavelengths.size(); ++i) {
    const Conductor one{Spectrum(c.indices[i].eta), Spectrum(c.indices[i].k), c.alpha_x, c.alpha_y};
    mean += evaluate(one, wi, wo, Transport::radiance).f[0] * rgb_shares(c.wavelengths)[i];
  }
  const Spectrum found = evaluate(Measured{&brdf, rgb}, wi, wo, Transport::radiance).f;
  EXPECT_NEAR(found[0], mean.r, 0.03f * mean.r);
  EXPECT_NEAR(found[1], mean.g, 0.03f * mean.g);
  EXPECT_NEAR(found[2], mean.b, 0.03f * mean.b);
  EXPECT_EQ(found[3], 0);
  EXPECT_GT(found[0], 1.5f * found[2]);
  // Data that only have RGB values are upsampled to spectra.
  const MeasuredData coloured = measure({.indices = gold});
  const MeasuredBrdf colours(coloured);
  const Wavelengths red{.mode = ColorMode::spectral, .lambda = {650, 640, 420, 430}, .pdf = {1, 1, 1, 1}};
  const Spectrum upsampled = evaluate(Measured{&colours, red}, wi, wo, Transport::radiance).f;
  EXPECT_GT(upsampled[0], 1.5f * upsampled[2]);
  EXPECT_GT(upsampled[2], 0);
}

TEST(Measured, SharesOfWavelengthsAddToOne) {
  const std::vector<float> nm{300, 420, 470, 500, 555, 600, 650, 900};
  Rgb sum{};
  for (const Rgb& share : rgb_shares(nm)) sum += share;
  EXPECT_NEAR(sum.r, 1, 1e-5f);
  EXPECT_NEAR(sum.g, 1, 1e-5f);
  EXPECT_NEAR(sum.b, 1, 1e-5f);
}

TEST(Measured, LightPathsSeeTheSameSurface) {
  const MeasuredData data = measure({.alpha_x = 0.3f, .alpha_y = 0.3f, .indices = gold});
  const MeasuredBrdf brdf(data);
  const Measured m{&brdf, rgb};
  HashRng rng(3);
  double asymmetry = 0;
  int count = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 a = sample_uniform_sphere(rng.next2()), b = sample_uniform_sphere(rng.next2());
    const float there = evaluate(m, a, b, Transport::radiance).f[0],
                back = evaluate(m, b, a, Transport::importance).f[0];
    EXPECT_EQ(there, back);
    EXPECT_TRUE(there == 0 || same_hemisphere(a, b));
    const float turned = evaluate(m, b, a, Transport::radiance).f[0];
    if (!(there > 0.01f && std::fabs(a.z) > 0.2f && std::fabs(b.z) > 0.2f)) continue;
    asymmetry += static_cast<double>(std::fabs(turned / there - 1));
    ++count;
  }
  // The measured conductor is reciprocal, so the table is too, up to its resolution.
  ASSERT_GT(count, 50);
  EXPECT_LT(asymmetry / count, 0.05);
}

double reflected(const Bsdf& bsdf, const Vec3& wi) {
  double sum = 0;
  const int side = 200;
  for (int i = 0; i < side * side; ++i) {
    const Vec2 u = (Vec2(static_cast<float>(i % side), static_cast<float>(i / side)) + Vec2(0.5f)) / float{side};
    if (const auto s = sample(bsdf, wi, 0.5f, u, Transport::radiance)) sum += static_cast<double>(s->weight[0]);
  }
  return sum / (side * side);
}

TEST(Measured, WhiteConductorsReflectAsMuchAsTheyDid) {
  for (const float alpha : {0.1f, 0.4f, 0.9f}) {
    const MeasuredData data = measure({.alpha_x = alpha, .alpha_y = alpha, .indices = {3, {1e-3f, 1e3f}}});
    const MeasuredBrdf brdf(data);
    const Measured m{&brdf, rgb};
    const Conductor white{Spectrum(1e-3f), Spectrum(1e3f), alpha, alpha};
    for (const float theta : {2.0f, 40.0f, 75.0f}) {
      const double here = reflected(m, at_angles(theta, 20));
      EXPECT_LT(here, 1.0) << alpha << ' ' << theta;
      EXPECT_NEAR(here, reflected(white, at_angles(theta, 20)), 0.02) << alpha << ' ' << theta;
      EXPECT_NEAR(static_cast<double>(albedo(m, at_angles(theta, 20))[0]), here, 0.02) << alpha << theta;
    }
  }
}

TEST(Measured, SamplesAndLobesAreThoseOfAClosure) {
  const MeasuredData data = measure({.alpha_x = 0.5f, .alpha_y = 0.2f, .indices = gold, .azimuths = 9});
  const MeasuredBrdf brdf(data);
  const Bsdf m = Measured{&brdf, rgb};
  HashRng rng(2);
  int drawn = 0;
  for (const Vec3& wi : {at_angles(1, 20), at_angles(40, 70), at_angles(80, -100), at_angles(165, 200),
                         at_angles(90.01, 30), Vec3(1, 0, 0), Vec3(1, 0, 1e-7f)}) {
    for (int n = 0; n < 300; ++n) {
      const auto s = sample(m, wi, 0.5f, n == 0 ? Vec2(0) : rng.next2(), Transport::importance);
      if (!s) continue;
      ++drawn;
      EXPECT_TRUE(is_finite(s->weight) && std::isfinite(s->pdf) && s->pdf > 0);
      EXPECT_TRUE(same_hemisphere(wi, s->wo) && !s->transmission && !s->delta);
      EXPECT_NEAR(length_squared(s->wo), 1, 1e-5f);
      EXPECT_EQ(evaluate(m, wi, s->wo, Transport::radiance).pdf, s->pdf);
    }
    const LobeWeights lobes = lobe_weights(m, wi);
    EXPECT_EQ(lobes.glossy, 1);
    EXPECT_GT(lobes.alpha, 0);
    EXPECT_LE(max_component(albedo(m, wi)), 1);
  }
  EXPECT_GT(drawn, 1000);
  EXPECT_TRUE(has_non_delta(m));
  EXPECT_FALSE(is_dispersive(m));
}

TEST(Measured, DataWithoutFactorAreThePlainReflectanceTimesTheCosine) {
  MeasuredData data = measure({.indices = gold});
  data.weighted = false;
  data.reflectance.values.assign(data.reflectance.values.size(), 0.5f);
  const MeasuredBrdf brdf(data);
  const Vec3 wo = at_angles(50, 100);
  EXPECT_NEAR(evaluate(Measured{&brdf, rgb}, at_angles(20, 0), wo, Transport::radiance).f[1], 0.5f / wo.z, 1e-4f);
}

}  // namespace
}  // namespace lanthorn::measured_test
