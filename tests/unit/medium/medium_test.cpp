// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The phase function and flights against integrals. Monte Carlo means have fixed seeds and bounds of 5 standard errors
// (false-alarm rate below 1e-6 each).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "medium/medium.h"

namespace lanthorn::medium_test {
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

// Compares the moments of the samples' cosines with the moments of the density, and checks the density returned with
// each sample.
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

// In every channel: how much light passes, and how much scatters before and after a given distance.
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
  EXPECT_EQ(f.weight[1], m.attenuation(2, rgb).transmittance[1]);
}

TEST(Homogeneous, InfiniteSegmentsEnd) {
  HomogeneousMedium m = chromatic();
  EXPECT_EQ(m.attenuation(infinity, rgb).transmittance[0], 0);
  m.sigma_s = m.sigma_a = SpectrumCurve::constant(0);
  EXPECT_EQ(m.attenuation(infinity, rgb).transmittance[0], 1);
  HashRng rng(4);
  EXPECT_EQ(m.fly(infinity, Spectrum(1), rgb, rng).weight[0], 1);
  EXPECT_TRUE(chromatic().fly(infinity, Spectrum(1, 0, 0, 0), rgb, rng).distance);
}

// An infinitely deep emissive medium without scattering has its emission as radiance; a thin one sigma_a L_e length.
TEST(Homogeneous, EmissionIsIntegratedAlongTheRay) {
  HomogeneousMedium m = chromatic();
  m.emission = SpectrumCurve::constant(3);
  m.sigma_s = SpectrumCurve::constant(0);
  EXPECT_NEAR(m.emission_along(infinity, rgb).emitted[1], 3, 1e-5);
  EXPECT_NEAR(m.emission_along(0.01f, rgb).emitted[1], 3 * (1 - std::exp(-0.005)), 1e-5);
}

// A density that varies by a factor of 40 along the segment, in a box that the segment enters and leaves.
DensityMedium varied() {
  DensityMedium m;
  m.sigma_a = SpectrumCurve::unbounded({0.2f, 0.5f, 1.0f});
  m.sigma_s = SpectrumCurve::unbounded({0.4f, 1.0f, 0.5f});
  m.to_medium = translate({0, 0, 2}) * scale({0.5f, 0.5f, 0.5f});
  GridDensity density{{{3, 2, 4}, {}, {Point(-1, -1, 0), Point(1, 1, 4)}}};
  for (int i = 0; i < 24; ++i)
    density.grid.values.push_back(0.2f * static_cast<float>(i % 5) * static_cast<float>(i % 3) + 0.03f);
  m.majorants = BlockGrid(density.box(), 16, [&](const Bounds& cell) { return density.bound(cell); });
  m.density = std::move(density);
  return m;
}
const Segment across{Point(-1.3f, 0.4f, -5), normalize(Vec3(0.2f, -0.1f, 0.8f)), 9};

double optical_depth(const DensityMedium& m, const Segment& s, double sigma, double length) {
  constexpr int steps = 20'000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const auto t = static_cast<float>(length * (i + 0.5) / steps);
    sum += static_cast<double>(density_at(m.density, m.to_medium.point(s.origin + t * s.direction)));
  }
  return sigma * sum * length / steps;
}

TEST(Varying, FlightsAndTransmittanceAreUnbiased) {
  const Medium medium = varied();
  const auto& m = std::get<DensityMedium>(medium);
  const Spectrum s = m.sigma_s.evaluate(rgb), t = s + m.sigma_a.evaluate(rgb);
  std::array<Mean, 3> through, ratio, early;
  HashRng rng(6);
  constexpr float split = 5;
  for (int i = 0; i < 100'000; ++i) {
    const Flight f = fly(medium, across, Spectrum(0.5f, 1, 0.2f, 0), rgb, rng);
    const Spectrum r = transmittance(medium, across, rgb, rng);
    for (unsigned c = 0; c < 3; ++c) {
      const double weight = static_cast<double>(f.weight[static_cast<int>(c)]);
      through[c].add(f.distance ? 0 : weight);
      early[c].add(f.distance && *f.distance < split ? weight : 0);
      ratio[c].add(static_cast<double>(r[static_cast<int>(c)]));
    }
  }
  for (unsigned c = 0; c < 3; ++c) {
    const double sigma_t = static_cast<double>(t[static_cast<int>(c)]);
    const double expected = std::exp(-optical_depth(m, across, sigma_t, static_cast<double>(across.length)));
    ASSERT_GT(expected, 0.005);
    EXPECT_NEAR(through[c].mean(), expected, 5 * through[c].error()) << c;
    EXPECT_NEAR(ratio[c].mean(), expected, 5 * ratio[c].error()) << c;
    const double scattered = (1 - std::exp(-optical_depth(m, across, sigma_t, static_cast<double>(split)))) *
                             static_cast<double>(s[static_cast<int>(c)]) / sigma_t;
    EXPECT_NEAR(early[c].mean(), scattered, 5 * early[c].error()) << c;
  }
}

// Nowhere may the density exceed the majorant: the estimates above would be biased.
TEST(Varying, MajorantsBound) {
  const DensityMedium m = varied();
  HashRng rng(7);
  for (int i = 0; i < 2000; ++i) {
    const Point a(4 * rng.next() - 2, 4 * rng.next() - 2, 6 * rng.next() - 1);
    const Segment s{a, Vec3(rng.next() - 0.5f, rng.next() - 0.5f, rng.next() - 0.5f), 20};
    float last = 0;
    m.majorants.for_each_piece(s, [&](float t0, float t1, float majorant) {
      EXPECT_LT(t0, t1);
      EXPECT_TRUE(last == 0 || std::fabs(t0 - last) < 1e-4f * (1 + last));
      last = t1;
      for (int k = 0; k <= 4; ++k) {
        const float t = t0 + 0.25f * static_cast<float>(k) * (t1 - t0);
        EXPECT_LE(density_at(m.density, s.origin + t * s.direction), majorant + 1e-4f);
      }
      return true;
    });
  }
}

TEST(Varying, CloudsStayBelowTheirBound) {
  const CloudDensity cloud;
  HashRng rng(8);
  float largest = 0;
  for (int i = 0; i < 5000; ++i) {
    const float d = cloud.at({rng.next(), rng.next(), rng.next()});
    ASSERT_GE(d, 0);
    ASSERT_LE(d, 1);
    largest = std::max(largest, d);
  }
  EXPECT_GT(largest, 0.5f);
  EXPECT_EQ(cloud.at(Point(0.5f, 0.2f, -0.01f)), 0);
}

// A medium at a temperature emits as a black body, and absorbs part of its emission on the way out.
TEST(Varying, BlackBodiesEmit) {
  DensityMedium m = varied();
  m.density = GridDensity{{{1, 1, 1}, {1}, {Point(-100), Point(100)}}};
  m.majorants = BlockGrid({Point(-100), Point(100)}, 16, [](const Bounds&) { return 1.0f; });
  m.sigma_s = SpectrumCurve::constant(0);
  m.sigma_a = SpectrumCurve::constant(1);
  m.to_medium = {};
  m.emission = BlackbodyEmission{GridDensity{{{1, 1, 1}, {3000}, {Point(-100), Point(100)}}}, 0, 1, 2};
  const Wavelengths w = Wavelengths::spectral(0.3f);
  HashRng rng(9);
  std::array<Mean, 4> mean;
  const Medium medium = m;
  for (int i = 0; i < 20'000; ++i) {
    const Spectrum emitted = emission_along(medium, {Point(0), Vec3(0, 0, 1), 1}, w, rng).emitted;
    for (unsigned c = 0; c < 4; ++c) mean[c].add(static_cast<double>(emitted[static_cast<int>(c)]));
  }
  for (unsigned c = 0; c < 4; ++c) {
    const auto planck = [](double nm) { return 1 / (std::pow(nm, 5) * std::expm1(1.438776877e7 / (nm * 3000))); };
    const double expected =
        2 * planck(static_cast<double>(w.lambda[c])) / planck(2.897771955e6 / 3000) * (1 - std::exp(-1.0));
    EXPECT_NEAR(mean[c].mean(), expected, 5 * mean[c].error() + 0.01 * expected) << c;
  }
}

// The curve, which serves all points of a segment, has the transmittance to each point as its mean.
TEST(TransmittanceCurve, IsTransmittanceUpToEveryPoint) {
  const Segment way{{0.1f, 0.2f, 1}, {0, 0, 1}, 5};
  const Medium even = chromatic(), on_grid = varied();
  HashRng rng(7);
  EXPECT_EQ(TransmittanceCurve(even, way, rgb, rng).to(0.7f),
            std::get<HomogeneousMedium>(even).attenuation(0.7f, rgb).transmittance);
  const std::array<float, 4> ends{0.5f, 1.3f, 2.2f, 4.5f};
  std::array<Mean, 4> by_curve, by_parts;
  for (int i = 0; i < 50'000; ++i) {
    const TransmittanceCurve curve(on_grid, way, rgb, rng);
    for (std::size_t e = 0; e < ends.size(); ++e) {
      by_curve[e].add(static_cast<double>(curve.to(ends[e])[1]));
      by_parts[e].add(static_cast<double>(transmittance(on_grid, {way.origin, way.direction, ends[e]}, rgb, rng)[1]));
    }
  }
  for (std::size_t e = 0; e < ends.size(); ++e) {
    const double error = std::hypot(by_curve[e].error(), by_parts[e].error());
    EXPECT_NEAR(by_curve[e].mean(), by_parts[e].mean(), 5 * error) << ends[e];
  }
  EXPECT_LT(by_curve[3].mean(), 0.5);
}

// MIS weights use the optical depth of the mean over wavelengths, both for flights and for whole segments.
TEST(Homogeneous, AttenuationIsThatOfEachWavelength) {
  HomogeneousMedium m;
  m.sigma_a = SpectrumCurve::unbounded({0.1f, 0.1f, 0.4f});
  m.sigma_s = SpectrumCurve::unbounded({0.2f, 0.2f, 0.5f});
  const Attenuation way = m.attenuation(2, rgb);
  const std::array<float, 4> depths{0.6f, 0.6f, 1.8f, 0};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(way.transmittance[i], std::exp(-depths[static_cast<unsigned>(i)]), 1e-6f);
  EXPECT_NEAR(way.optical_depth, 1.0f, 1e-6f);
  const Attenuation endless = m.attenuation(infinity, rgb);
  EXPECT_EQ(endless.transmittance, Spectrum(0, 0, 0, 1));
  HashRng rng(3);
  int scattered = 0;
  for (int i = 0; i < 100; ++i) {
    const Flight flight = m.fly(2, {1, 1, 1, 0}, rgb, rng);
    EXPECT_NEAR(flight.optical_depth, flight.distance.value_or(2) / 2, 1e-6f);
    scattered += flight.distance ? 1 : 0;
  }
  EXPECT_GT(scattered, 20);
  EXPECT_LT(scattered, 90);
}

TEST(Medium, KnowsWhereItScatters) {
  const Medium even = chromatic(), on_grid = varied();
  EXPECT_NEAR(scattering_at(even, Point(5), rgb)[1], 1, 1e-6f);
  const float far = scattering_length(even, {}, rgb);
  EXPECT_LT(std::get<HomogeneousMedium>(even).attenuation(far, rgb).transmittance[0], 0x1p-24f);
  EXPECT_EQ(scattering_length(even, {{}, {0, 0, 1}, 2}, rgb), 2);
  // The medium's box ends at z = 4.
  EXPECT_NEAR(scattering_length(on_grid, {{0, 0, 1}, {0, 0, 1}, infinity}, rgb), 3, 1e-5f);
  EXPECT_EQ(scattering_length(on_grid, {{0, 0, 5}, {0, 0, 1}, infinity}, rgb), 0);
  EXPECT_TRUE(scattering_at(on_grid, {0, 0, 5}, rgb).is_black());
  EXPECT_FALSE(scattering_at(on_grid, {0.1f, 0.1f, 3}, rgb).is_black());
}

}  // namespace
}  // namespace lanthorn::medium_test
