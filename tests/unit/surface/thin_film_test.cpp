// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reflectance of thin films against sums of complex amplitudes and closed forms, and in RGB against spectra.
#include "surface/thin_film.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "spectrum/cie.h"
#include "surface/fresnel.h"

namespace lanthorn::thin_film_test {
namespace {

constexpr double pi_d = std::numbers::pi;
const Wavelengths spectral = Wavelengths::spectral(0.3f);
const Wavelengths rgb = Wavelengths::rgb(0.5f);
const std::array<float, 5> cosines{1, 0.8f, 0.45f, 0.2f, 0.02f};

// Amplitudes at an interface from index a to index b, given the cosines of the two rays.
struct Amplitudes {
  double r, t;
};
Amplitudes perpendicular(double a, double b, double cos_a, double cos_b) {
  return {(a * cos_a - b * cos_b) / (a * cos_a + b * cos_b), 2 * a * cos_a / (a * cos_a + b * cos_b)};
}
Amplitudes parallel(double a, double b, double cos_a, double cos_b) {
  return {(b * cos_a - a * cos_b) / (b * cos_a + a * cos_b), 2 * a * cos_a / (b * cos_a + a * cos_b)};
}

// The light reflected by the film's top, after one round trip in the film, after two, ..., summed with phases.
double sum_of_reflections(double cos_i, double film, double base, double phase, auto interface) {
  const double sin2 = 1 - cos_i * cos_i;
  const double cos_film = std::sqrt(1 - sin2 / (film * film)), cos_base = std::sqrt(1 - sin2 / (base * base));
  const Amplitudes in = interface(1, film, cos_i, cos_film), out = interface(film, 1, cos_film, cos_i);
  const Amplitudes below = interface(film, base, cos_film, cos_base);
  std::complex<double> sum = in.r, term = in.t * below.r * out.t * std::polar(1.0, phase);
  for (int i = 0; i < 4000; ++i) {
    sum += term;
    term *= out.r * below.r * std::polar(1.0, phase);
  }
  return std::norm(sum);
}

TEST(ThinFilm, IsTheSumOfAllReflections) {
  for (const float index : {1.0f, 1.33f, 2.4f})
    for (const float base : {1.0f, 1.5f, 4.0f})
      for (const float thickness : {1.0f, 250.0f, 1200.0f})
        for (const float cosine : cosines) {
          const Spectrum r = film_reflectance({index, thickness, spectral}, cosine, Spectrum(base));
          const double c = cosine, n = index, b = base;
          const double way = 2 * n * static_cast<double>(thickness) * std::sqrt(1 - (1 - c * c) / (n * n));
          for (unsigned i = 0; i < 4; ++i) {
            const double phase = 2 * pi_d * way / static_cast<double>(spectral.lambda[i]);
            const double expected = 0.5 * (sum_of_reflections(c, n, b, phase, perpendicular) +
                                           sum_of_reflections(c, n, b, phase, parallel));
            EXPECT_NEAR(static_cast<double>(r.v[i]), expected, 1e-4)
                << index << " on " << base << ", " << thickness << " nm, cos " << cosine;
          }
        }
}

TEST(ThinFilm, WithoutThicknessTheSurfaceReflectsAsItIs) {
  for (const Wavelengths& w : {spectral, rgb})
    for (const float index : {1.3f, 2.0f})
      for (const float base : {1.1f, 1.5f, 3.0f})
        for (const float cosine : cosines) {
          const Spectrum r = film_reflectance({index, 1e-3f, w}, cosine, Spectrum(base));
          for (int i = 0; i < 3; ++i) EXPECT_NEAR(r[i], fresnel_dielectric(cosine, base).reflectance, 2e-3f) << cosine;
        }
  EXPECT_FALSE(ThinFilm(1.3f, 0, rgb));
}

// A quarter-wavelength film of index sqrt(n) on index n: its two reflections have equal magnitude and opposite sign.
TEST(ThinFilm, ACoatingOfAQuarterWavelengthRemovesTheReflection) {
  const float index = std::sqrt(1.5f);
  const ThinFilm film(index, spectral.lambda[1] / (4 * index), spectral);
  EXPECT_NEAR(film_reflectance(film, 1, Spectrum(1.5f))[1], 0, 1e-6f);
  EXPECT_GT(film_reflectance(film, 1, Spectrum(1.5f))[0], 1e-4f);
}

TEST(ThinFilm, ReflectsInRgbWhatItReflectsOfWhiteLight) {
  constexpr int steps = 3000;
  for (const float index : {1.33f, 1.8f})
    for (const float base : {1.0f, 1.5f, 8.0f})
      for (const float thickness : {120.0f, 380.0f, 900.0f, 5000.0f})
        for (const float cosine : {1.0f, 0.6f, 0.15f}) {
          std::array<double, 3> expected{};
          for (int i = 0; i < steps; ++i) {
            const Wavelengths w = Wavelengths::spectral((static_cast<float>(i) + 0.5f) / steps);
            Spectrum light = film_reflectance({index, thickness, w}, cosine, Spectrum(base));
            for (unsigned k = 0; k < 4; ++k) light.v[k] *= illuminant_d65.at(w.lambda[k]);
            const Rgb seen = w.to_rgb(light);
            expected[0] += static_cast<double>(seen.r) / steps;
            expected[1] += static_cast<double>(seen.g) / steps;
            expected[2] += static_cast<double>(seen.b) / steps;
          }
          const Spectrum r = film_reflectance({index, thickness, rgb}, cosine, Spectrum(base));
          for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(static_cast<double>(r.v[c]), std::clamp(expected[c], 0.0, 1.0), 0.004)
                << index << " on " << base << ", " << thickness << " nm, cos " << cosine << " channel " << c;
        }
}

TEST(ThinFilm, IndicesHaveTheirReflectance) {
  const Spectrum index = index_from_reflectance(Spectrum(0, 0.04f, 0.5f, 1));
  EXPECT_EQ(index[0], 1);
  EXPECT_NEAR(index[1], 1.5f, 1e-6f);
  EXPECT_NEAR(fresnel_dielectric(1, index[2]).reflectance, 0.5f, 1e-6f);
  EXPECT_TRUE(std::isfinite(index[3]));
}

}  // namespace
}  // namespace lanthorn::thin_film_test
