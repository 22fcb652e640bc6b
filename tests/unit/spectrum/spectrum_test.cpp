// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "math/hash.h"
#include "spectrum/cie.h"
#include "spectrum/curve.h"
#include "spectrum/rgb_matrix.h"
#include "spectrum/sigmoid_fit.h"
#include "spectrum/wavelengths.h"

namespace lanthorn::spectrum_test {
namespace {

constexpr ColorSpace all_spaces[] = {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::aces2065_1};

Rgb to_float(const Tristimulus& c) {
  return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}
float nm_of(std::size_t i) { return lambda_min + static_cast<float>(i); }

template <class Value>
DenseSpectrum tabulate(Value&& value) {
  DenseSpectrum s;
  for (std::size_t i = 0; i < s.values.size(); ++i) s.values[i] = value(nm_of(i));
  return s;
}
/// Linear RGB of light in a colour space, by quadrature at intervals of 1 nm.
Rgb seen(const DenseSpectrum& light, ColorSpace space = ColorSpace::srgb) {
  return to_float(inverse(rgb_to_xyz(space)) * to_xyz(light));
}
Rgb reflected(const SpectrumCurve& curve, ColorSpace space = ColorSpace::srgb) {
  return seen(tabulate([&](float nm) { return curve.at(nm) * illuminant_of(space).at(nm); }), space);
}
float max_difference(const Rgb& a, const Rgb& b) {
  return std::max({std::fabs(a.r - b.r), std::fabs(a.g - b.g), std::fabs(a.b - b.b)});
}

/// Mean film RGB of a spectrum over `count` equally spaced u (the four strata make it a fine quadrature).
template <class Evaluate>
Rgb film_mean(Evaluate&& evaluate, int count = 4096) {
  double r = 0, g = 0, b = 0;
  for (int i = 0; i < count; ++i) {
    const Wavelengths w = Wavelengths::spectral((static_cast<float>(i) + 0.5f) / static_cast<float>(count));
    const Rgb c = w.to_rgb(evaluate(w));
    r += double{c.r}, g += double{c.g}, b += double{c.b};
  }
  return to_float((1.0 / count) * Tristimulus{r, g, b});
}

struct Chromaticity {
  double x, y;
};
Chromaticity chromaticity(const DenseSpectrum& s) {
  const Tristimulus c = to_xyz(s);
  return {c.x / (c.x + c.y + c.z), c.y / (c.x + c.y + c.z)};
}

TEST(Cie, IntegralOfLuminosityIsTheFilmConstant) { EXPECT_NEAR(cie_y_integral, 106.856895, 1e-4); }

TEST(Cie, IlluminantsHaveTheirPublishedChromaticities) {
  struct Published {
    const char* name;
    double x, y, tolerance = 3e-4;
  };
  // CIE 15:2004, tables 11.1 to 11.4. The published samples of F10 do not quite give its published chromaticity.
  constexpr Published published[] = {
      {"stdillum-A", 0.44757, 0.40745},         {"stdillum-D50", 0.34567, 0.35850}, {"stdillum-D65", 0.31272, 0.32903},
      {"stdillum-F1", 0.31310, 0.33727},        {"stdillum-F2", 0.37208, 0.37529},  {"stdillum-F3", 0.40910, 0.39430},
      {"stdillum-F4", 0.44018, 0.40329},        {"stdillum-F5", 0.31379, 0.34531},  {"stdillum-F6", 0.37790, 0.38835},
      {"stdillum-F7", 0.31292, 0.32933},        {"stdillum-F8", 0.34588, 0.35875},  {"stdillum-F9", 0.37417, 0.37281},
      {"stdillum-F10", 0.34609, 0.35986, 1e-3}, {"stdillum-F11", 0.38052, 0.37713}, {"stdillum-F12", 0.43695, 0.40441}};
  for (const Published& p : published) {
    const DenseSpectrum* s = named_spectrum(p.name);
    ASSERT_NE(s, nullptr) << p.name;
    const Chromaticity c = chromaticity(*s);
    EXPECT_NEAR(c.x, p.x, p.tolerance) << p.name;
    EXPECT_NEAR(c.y, p.y, p.tolerance) << p.name;
    EXPECT_NEAR(luminance_of(*s), 1, 1e-5) << p.name;
  }
  EXPECT_NEAR(chromaticity(illuminant_aces).x, 0.32168, 3e-4);
  EXPECT_NEAR(chromaticity(illuminant_aces).y, 0.33767, 3e-4);
}

TEST(Cie, Rec709MatrixIsThePublishedOne) {
  const Matrix3 m = rgb_to_xyz(ColorSpace::srgb);  // IEC 61966-2-1, whose white is rounded
  EXPECT_NEAR(m.row[0].x, 0.4124, 5e-4);
  EXPECT_NEAR(m.row[1].y, 0.7152, 5e-4);
  EXPECT_NEAR(m.row[2].z, 0.9505, 5e-4);
  for (const ColorSpace space : all_spaces)
    EXPECT_LT(max_difference(seen(illuminant_of(space), space), {1, 1, 1}), 1e-5f);
}

// The matrices from ACEScg and ACES2065-1 to Rec.709 as the Academy's transforms have them (aces-dev 1.0.3, with
// Bradford's adaptation from D60 to D65), and from Rec.2020 as ITU-R BT.2087 has it.
TEST(Chromaticities, GiveThePublishedMatricesToRec709) {
  struct Case {
    Chromaticities from;
    RgbMatrix to;
  };
  const std::vector<Case> cases{
      {{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f},
       {{{{1.70505f, -0.62179f, -0.08326f}, {-0.13026f, 1.14080f, -0.01055f}, {-0.02400f, -0.12897f, 1.15297f}}}}},
      {{0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f},
       {{{{2.52169f, -1.13413f, -0.38756f}, {-0.27648f, 1.37272f, -0.09624f}, {-0.01538f, -0.15298f, 1.16835f}}}}},
      {{0.708f, 0.292f, 0.17f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f},
       {{{{1.6605f, -0.5876f, -0.0728f}, {-0.1246f, 1.1329f, -0.0083f}, {-0.0182f, -0.1006f, 1.1187f}}}}}};
  for (const auto& [from, to] : cases) {
    const std::optional<RgbMatrix> found = rec709_from(from);
    ASSERT_TRUE(found);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(max_difference(found->rows[i], to.rows[i]), 6e-5f) << i;
  }
}

// Files in XYZ have the blue primary (0, 0), which has no XYZ of luminance 1.
TEST(Chromaticities, KeepWhiteAndRec709) {
  EXPECT_EQ(rec709_from(rec709_chromaticities), RgbMatrix());
  EXPECT_EQ(rec709_from({0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.313f, 0.329f}), RgbMatrix());
  const Chromaticities xyz{1, 0, 0, 1, 0, 0, 1.0f / 3, 1.0f / 3};
  for (const Chromaticities& from : {xyz, {0.68f, 0.32f, 0.265f, 0.69f, 0.15f, 0.06f, 0.314f, 0.351f}}) {
    const std::optional<RgbMatrix> matrix = rec709_from(from);
    ASSERT_TRUE(matrix);
    EXPECT_LT(max_difference(*matrix * Rgb{1, 1, 1}, {1, 1, 1}), 1e-5f);
  }
  // Y alone has no red and no blue of XYZ; its green is the only one above 0.
  const Rgb y = *rec709_from(xyz) * Rgb{0, 1, 0};
  EXPECT_TRUE(y.g > 1 && y.r < 0 && y.b < 0);
}

TEST(Chromaticities, ThatNoColoursCanHaveAreRefused) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < 8; ++i)
    for (const float bad : {nan, infinity, -infinity, 1e30f}) {
      Chromaticities c = rec709_chromaticities;
      c[i] = bad;
      EXPECT_FALSE(rec709_from(c)) << i << ' ' << bad;
    }
  EXPECT_FALSE(rec709_from({}));
  EXPECT_FALSE(rec709_from({0.64f, 0.33f, 0.64f, 0.33f, 0.15f, 0.06f, 0.3127f, 0.329f})) << "equal primaries";
  EXPECT_FALSE(rec709_from({0.1f, 0.1f, 0.2f, 0.2f, 0.4f, 0.4f, 0.3127f, 0.329f})) << "on one line";
  EXPECT_FALSE(rec709_from({0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0})) << "white without luminance";
  EXPECT_FALSE(rec709_from({0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.9f, 0.09f})) << "white without blue cones";
}

TEST(Wavelengths, DensityIntegratesToOne) {
  double sum = 0;
  constexpr int count = 512 * 64;  // equally many in each cell of the table
  for (int i = 0; i < count; ++i) {
    // The mean of 1/pdf over u is the length of the range.
    const Wavelengths w = Wavelengths::spectral((static_cast<float>(i) + 0.5f) / count);
    ASSERT_GE(w.lambda[0], lambda_min);
    ASSERT_LE(w.lambda[0], lambda_max);
    sum += 1 / double{w.pdf[0]};
  }
  EXPECT_NEAR(sum / count, double{lambda_max} - double{lambda_min}, 0.05);
}

TEST(Wavelengths, HistogramMatchesDensity) {
  // Equally spaced u: the fraction of samples in a bin is the density's integral over it, up to 1/count.
  constexpr int count = 200000, bins = 47;
  std::vector<double> found(bins), expected(bins);
  for (int i = 0; i < count; ++i) {
    const Wavelengths w = Wavelengths::spectral((static_cast<float>(i) + 0.5f) / count);
    const int bin = std::min(bins - 1, static_cast<int>((w.lambda[0] - lambda_min) / 10));
    found[static_cast<std::size_t>(bin)] += 1.0 / count;
  }
  for (std::size_t bin = 0; bin < bins; ++bin) {
    for (int i = 0; i < 100; ++i) {
      const double nm = double{lambda_min} + 10 * (static_cast<double>(bin) + (i + 0.5) / 100);
      // u of this wavelength by bisection, so that the density comes from the code under test.
      float low = 0, high = 1;
      for (int step = 0; step < 24; ++step) {
        const float u = 0.5f * (low + high);
        (double{Wavelengths::spectral(u).lambda[0]} < nm ? low : high) = u;
      }
      expected[bin] += 0.1 * double{Wavelengths::spectral(low).pdf[0]};
    }
    EXPECT_NEAR(found[bin], expected[bin], 2e-4) << "bin " << bin;
  }
}

TEST(Wavelengths, FourAreStratified) {
  const Wavelengths w = Wavelengths::spectral(0.9f);
  const float shifted[] = {0.9f, 0.15f, 0.4f, 0.65f};
  for (unsigned i = 0; i < 4; ++i) EXPECT_NEAR(w.lambda[i], Wavelengths::spectral(shifted[i]).lambda[0], 1e-3f);
}

// How much the four wavelengths of a path tint white light. Measured: .0164 (blue of 2856 K); .42 with a density like
// the eye's response.
TEST(Wavelengths, FourShowWhiteLightNearlyWhite) {
  constexpr int count = 1000;
  for (const DenseSpectrum& light : {illuminant_d65, blackbody(2856), blackbody(5000)}) {
    std::array<double, 3> sum{}, squares{};
    for (int i = 0; i < count; ++i) {
      const Wavelengths w = Wavelengths::spectral((static_cast<float>(i) + 0.5f) / count);
      Spectrum at_four;
      for (unsigned j = 0; j < 4; ++j) at_four.v[j] = light.at(w.lambda[j]);
      const Rgb c = w.to_rgb(at_four);
      const std::array<float, 3> channels{c.r, c.g, c.b};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto x = static_cast<double>(channels[k]);
        sum[k] += x;
        squares[k] += x * x;
      }
    }
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(count * squares[k] / (sum[k] * sum[k]) - 1, 0.02) << k;
  }
}

TEST(Wavelengths, WhiteLightGivesWhitePixel) {
  const SpectrumCurve white = SpectrumCurve::illuminant({1, 1, 1});
  EXPECT_LT(max_difference(film_mean([&](const Wavelengths& w) { return white.evaluate(w); }), {1, 1, 1}), 1e-3f);
  EXPECT_LT(max_difference(seen(tabulate([&](float nm) { return white.at(nm); })), {1, 1, 1}), 1e-5f);
}

TEST(Wavelengths, HeroAloneHasTheSameMean) {
  const SpectrumCurve light = SpectrumCurve::illuminant({0.9f, 0.6f, 0.3f});
  const Rgb hero = film_mean([&](const Wavelengths& w) { return light.evaluate(w) * w.dispersed; }, 65536);
  EXPECT_LT(max_difference(hero, {0.9f, 0.6f, 0.3f}), 2e-3f);
}

TEST(Wavelengths, DispersedHasMeanOneInRgbMode) {
  constexpr int count = 1 << 18;
  Tristimulus sum;
  for (int i = 0; i < count; ++i) {
    const Wavelengths w = Wavelengths::rgb((static_cast<float>(i) + 0.5f) / count);
    ASSERT_EQ(w.dispersed[3], 0);
    sum = sum + Tristimulus{double{w.dispersed[0]}, double{w.dispersed[1]}, double{w.dispersed[2]}};
  }
  EXPECT_LT(max_difference(to_float((1.0 / count) * sum), {1, 1, 1}), 1e-4f);
}

TEST(Wavelengths, RgbModePassesEstimatesThrough) {
  EXPECT_EQ(Wavelengths::rgb(0.3f).to_rgb({1, 2, 3, 0}), (Rgb{1, 2, 3}));
}

TEST(Upsampling, SolverRoundTripsTheGamut) {
  float worst = 0;
  for (int r = 0; r <= 10; ++r)
    for (int g = 0; g <= 10; ++g)
      for (int b = 0; b <= 10; ++b) {
        const Rgb c{0.1f * static_cast<float>(r), 0.1f * static_cast<float>(g), 0.1f * static_cast<float>(b)};
        const float error = max_difference(reflected(SpectrumCurve::albedo(c)), c);
        worst = std::max(worst, error);
        EXPECT_LE(error, 1e-3f) << c.r << ' ' << c.g << ' ' << c.b;
      }
  RecordProperty("worst", std::to_string(worst));
}

/// Error of the tabulated coefficients of one colour.
float table_error(const Rgb& c) {
  SpectrumCurve curve;
  curve.shape = SpectrumCurve::Shape::sigmoid;
  curve.scale = 1;
  curve.c = sigmoid_coefficients(c);
  return max_difference(reflected(curve), c);
}

TEST(Upsampling, TableRoundTripsRandomColours) {
  HashRng rng(1);
  float worst = 0;
  for (int i = 0; i < 3000; ++i) worst = std::max(worst, table_error({rng.next(), rng.next(), rng.next()}));
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LE(worst, 5e-3f);
}

TEST(Upsampling, TableRoundTripsTintedWhites) {
  HashRng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const Rgb c{1, 1 - 0.1f * rng.next(), 1 - 0.1f * rng.next()};
    ASSERT_LE(table_error(c), 1e-2f) << c.g << ' ' << c.b;
  }
}

TEST(Upsampling, TableRoundTripsDarkColours) {
  HashRng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const float value = 0.01f + 0.05f * rng.next();
    const Rgb c{value, value * rng.next(), value * rng.next()};
    ASSERT_LE(table_error(c), 0.02f * value) << c.r << ' ' << c.g << ' ' << c.b;
  }
}

TEST(Upsampling, OtherSpacesRoundTripInsideRec709) {
  // Colours that a smooth reflectance can have: those inside Rec.709, converted to each space.
  HashRng rng(2);
  for (const ColorSpace space : all_spaces) {
    const Matrix3 m = inverse(rgb_to_xyz(space)) * rgb_to_xyz(ColorSpace::srgb);
    for (int i = 0; i < 100; ++i) {
      const float base = 0.05f + 0.4f * rng.next();
      const Rgb inside{base + 0.4f * rng.next(), base + 0.4f * rng.next(), base + 0.4f * rng.next()};
      const Rgb c = to_float(m * Tristimulus{double{inside.r}, double{inside.g}, double{inside.b}});
      const SpectrumCurve curve = SpectrumCurve::albedo(c, space);
      EXPECT_LE(max_difference(reflected(curve, space), c), 2e-3f);
    }
  }
}

TEST(Upsampling, WhiteAndGreyAreExactInEverySpace) {
  for (const ColorSpace space : all_spaces) {
    const SpectrumCurve grey = SpectrumCurve::albedo({0.18f, 0.18f, 0.18f}, space);
    for (const float nm : {400.0f, 555.0f, 700.0f}) EXPECT_EQ(grey.at(nm), 0.18f);
    EXPECT_EQ(grey.rgb, (Rgb{0.18f, 0.18f, 0.18f}));
  }
  for (const float value : {0.0f, 0.18f, 1.0f}) {
    const Wavelengths w = Wavelengths::spectral(0.4f);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(evaluate_albedo({value, value, value}, w)[i], value, 1e-6f);
  }
}

TEST(Upsampling, ReflectancesStayInUnitInterval) {
  HashRng rng(3);
  for (int i = 0; i < 2000; ++i) {
    const Rgb c{rng.next(), rng.next(), rng.next()};
    const Spectrum s = evaluate_albedo(c, Wavelengths::spectral(rng.next()));
    for (int k = 0; k < 4; ++k) {
      ASSERT_GE(s[k], 0);
      ASSERT_LE(s[k], 1);
    }
  }
}

TEST(Upsampling, VanishingColoursStayFiniteAndDark) {
  const Wavelengths w = Wavelengths::spectral(0.6f);
  for (const float tiny : {1e-8f, 1e-13f, 1e-30f, 1e-42f, 0.0f}) {
    const Rgb c{tiny, 0.3f * tiny, 0};
    for (const Spectrum& s : {evaluate_albedo(c, w), evaluate_illuminant(c, w), SpectrumCurve::albedo(c).evaluate(w),
                              SpectrumCurve::unbounded(c).evaluate(w), SpectrumCurve::illuminant(c).evaluate(w)}) {
      ASSERT_TRUE(is_finite(s)) << tiny;
      EXPECT_LE(max_component(s), 1e-6f) << tiny;
    }
  }
}

TEST(Upsampling, LightsConvergeToTheirColour) {
  for (const Rgb& c : {Rgb{17, 12, 4}, Rgb{0.02f, 0.02f, 0.02f}, Rgb{0.1f, 3, 0.4f}}) {
    const SpectrumCurve curve = SpectrumCurve::illuminant(c);
    const float tolerance = 2e-3f * max_component(c);
    EXPECT_LT(max_difference(film_mean([&](const Wavelengths& w) { return curve.evaluate(w); }), c), tolerance);
    EXPECT_LT(max_difference(film_mean([&](const Wavelengths& w) { return evaluate_illuminant(c, w); }), c),
              5 * tolerance);
    EXPECT_EQ(curve.rgb, c);
  }
}

TEST(Upsampling, ReflectancesUnderDaylightConvergeToTheirColour) {
  const Rgb c{0.63f, 0.065f, 0.05f};  // the red wall of the Cornell box
  const SpectrumCurve wall = SpectrumCurve::albedo(c);
  const SpectrumCurve light = SpectrumCurve::illuminant({1, 1, 1});
  EXPECT_LT(max_difference(film_mean([&](const Wavelengths& w) { return wall.evaluate(w) * light.evaluate(w); }), c),
            1e-3f);
}

TEST(Upsampling, RgbModeReturnsTheColour) {
  const Wavelengths w = Wavelengths::rgb(0.7f);
  const Rgb c{0.2f, 0.5f, 0.9f};
  const Spectrum expected{c.r, c.g, c.b, 0};
  EXPECT_EQ(SpectrumCurve::albedo(c).evaluate(w), expected);
  EXPECT_EQ(SpectrumCurve::unbounded(c).evaluate(w), expected);
  EXPECT_EQ(SpectrumCurve::illuminant(c).evaluate(w), expected);
  EXPECT_EQ(evaluate_albedo(c, w), expected);
  EXPECT_EQ(evaluate_illuminant(c, w), expected);
  EXPECT_EQ(SpectrumCurve::albedo(c).scaled(2).evaluate(w), 2.0f * expected);
}

TEST(Curve, UnboundedKeepsItsMagnitude) {
  const Rgb c{3, 0.5f, 40};
  EXPECT_LT(max_difference(reflected(SpectrumCurve::unbounded(c)), c), 1e-3f * 40);
  EXPECT_TRUE(SpectrumCurve::unbounded({0, 0, 0}).is_black());
  EXPECT_FALSE(SpectrumCurve::constant(1.5f).varies());
  EXPECT_EQ(SpectrumCurve::constant(1.5f).at(500), 1.5f);
}

TEST(Curve, EvaluateAgreesWithAt) {
  const SpectrumCurve curves[] = {SpectrumCurve::constant(2), SpectrumCurve::albedo({0.8f, 0.3f, 0.1f}),
                                  SpectrumCurve::tabulated(named_spectrum("metal-Au-eta")).scaled(3),
                                  SpectrumCurve::illuminant({4, 5, 6})};
  for (const SpectrumCurve& curve : curves) {
    const Wavelengths w = Wavelengths::spectral(0.37f);
    const Spectrum s = curve.evaluate(w);
    for (unsigned i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(s.v[i], curve.at(w.lambda[i]));
  }
}

TEST(Curve, BlackbodyPeaksWhereWienSays) {
  for (const float kelvin : {4000.0f, 5000.0f, 6500.0f, 7500.0f}) {
    const DenseSpectrum s = blackbody(kelvin);
    const auto peak = std::max_element(s.values.begin(), s.values.end()) - s.values.begin();
    EXPECT_NEAR(lambda_min + static_cast<float>(peak), 2.897771955e6f / kelvin, 0.6f);
    EXPECT_NEAR(luminance_of(normalized_luminance(s)), 1, 1e-5f);
  }
  // A ratio of Planck's law: B(500)/B(600) at 3000 K.
  const double c2 = 1.438776877e7;
  const double ratio = std::pow(1.2, 5) * std::expm1(c2 / (600 * 3000)) / std::expm1(c2 / (500 * 3000));
  EXPECT_NEAR(blackbody(3000).at(500) / blackbody(3000).at(600), ratio, 1e-5);
  EXPECT_GT(luminance_of(blackbody(300)), 0);
  EXPECT_EQ(luminance_of(blackbody(0)), 0);
}

TEST(Curve, ResampleJoinsSamplesByLines) {
  const float nm[] = {400, 500, 510};
  const float values[] = {1, 3, 0};
  const DenseSpectrum light = resample(nm, values, 3, false);
  const DenseSpectrum index = resample(nm, values, 3, true);
  EXPECT_FLOAT_EQ(light.at(425), 1.5f);
  EXPECT_FLOAT_EQ(light.at(500), 3);
  EXPECT_FLOAT_EQ(light.at(505), 1.5f);
  EXPECT_EQ(light.at(399), 0);
  EXPECT_EQ(index.at(360), 1);
  EXPECT_EQ(index.at(830), 0);
  EXPECT_EQ(index.at(831), 0);
  EXPECT_EQ(resample(nm, values, 1, true).at(700), 1);
  EXPECT_EQ(luminance_of(resample(nm, values, 0, true)), 0);
}

TEST(NamedSpectra, GlassesHaveTheirCatalogueIndices) {
  struct Catalogue {
    const char* name;
    double n_d, abbe;
  };
  // SCHOTT, Optical Glass 2017: N-BK7, N-BAF10, N-FK51A, N-LASF9, N-SF5, N-SF10, N-SF11.
  constexpr Catalogue catalogue[] = {{"glass-BK7", 1.51680, 64.17},   {"glass-BAF10", 1.67003, 47.11},
                                     {"glass-FK51A", 1.48656, 84.47}, {"glass-LASF9", 1.85025, 32.17},
                                     {"glass-F5", 1.67271, 32.25},    {"glass-F10", 1.72828, 28.53},
                                     {"glass-F11", 1.78472, 25.68}};
  for (const Catalogue& glass : catalogue) {
    const DenseSpectrum* eta = named_spectrum(glass.name);
    ASSERT_NE(eta, nullptr) << glass.name;
    const auto at = [&](double nm) {  // the spectral lines lie between whole nanometres
      const auto i = static_cast<std::size_t>(nm - double{lambda_min});
      const double t = nm - double{lambda_min} - static_cast<double>(i);
      return (1 - t) * double{eta->values[i]} + t * double{eta->values[i + 1]};
    };
    EXPECT_NEAR(at(587.5618), glass.n_d, 1e-5) << glass.name;
    EXPECT_NEAR((at(587.5618) - 1) / (at(486.1327) - at(656.2725)), glass.abbe, 0.02) << glass.name;
  }
}

double reflectance(double eta, double k) {
  const std::complex<double> n(eta, k);
  return std::norm((n - 1.0) / (n + 1.0));
}

TEST(NamedSpectra, MetalsHaveTheTabulatedConstantsAtTwoAndAHalfElectronvolts) {
  struct Sample {
    const char* name;
    float value;
  };
  constexpr Sample samples[] = {{"metal-Ag-eta", 0.13f},  {"metal-Ag-k", 2.88f},    {"metal-Al-eta", 0.755f},
                                {"metal-Al-k", 6.03f},    {"metal-Au-eta", 0.916f}, {"metal-Au-k", 1.84f},
                                {"metal-Cu-eta", 1.135f}, {"metal-Cu-k", 2.564f}};
  for (const Sample& sample : samples)
    EXPECT_NEAR(named_spectrum(sample.name)->at(496), sample.value, 2e-3f) << sample.name;
}

TEST(NamedSpectra, MetalsReflectAsMeasured) {
  const auto at = [](const std::string& name, float nm) {
    const DenseSpectrum* eta = named_spectrum(("metal-" + name + "-eta").c_str());
    const DenseSpectrum* k = named_spectrum(("metal-" + name + "-k").c_str());
    return eta && k ? reflectance(double{eta->at(nm)}, double{k->at(nm)}) : -1;
  };
  // CRC Handbook of Chemistry and Physics, normal incidence, for the first four.
  EXPECT_NEAR(at("Ag", 550), 0.96, 0.02);
  EXPECT_NEAR(at("Al", 550), 0.915, 0.01);
  EXPECT_NEAR(at("Au", 650), 0.94, 0.02);
  EXPECT_NEAR(at("Cu", 650), 0.94, 0.02);
  EXPECT_NEAR(at("CuZn", 600), 0.86, 0.02);
  EXPECT_NEAR(at("MgO", 590), 0.0725, 0.001);
  EXPECT_NEAR(at("TiO2", 590), 0.24, 0.01);
  EXPECT_EQ(named_spectrum("metal-unobtainium-eta"), nullptr);
}

TEST(NamedSpectra, MetalsInRgbModeResembleSpectralOnes) {
  for (const std::string name : {"Ag", "Al", "Au", "Cu", "CuZn"}) {
    const SpectrumCurve eta = SpectrumCurve::tabulated(named_spectrum(("metal-" + name + "-eta").c_str()));
    const SpectrumCurve k = SpectrumCurve::tabulated(named_spectrum(("metal-" + name + "-k").c_str()));
    const Rgb spectral = seen(tabulate([&](float nm) {
      return illuminant_d65.at(nm) * static_cast<float>(reflectance(double{eta.at(nm)}, double{k.at(nm)}));
    }));
    const auto channel = [](float n, float absorption) {
      return static_cast<float>(reflectance(double{n}, double{absorption}));
    };
    const Rgb rgb{channel(eta.rgb.r, k.rgb.r), channel(eta.rgb.g, k.rgb.g), channel(eta.rgb.b, k.rgb.b)};
    // Gold's measured colour lies outside Rec.709 (red 1.02), so no RGB reflectance can reach it.
    const Rgb inside{std::min(1.0f, spectral.r), std::min(1.0f, spectral.g), std::min(1.0f, spectral.b)};
    EXPECT_LT(max_difference(rgb, inside), 0.05f)
        << name << ": rgb " << rgb.r << ' ' << rgb.g << ' ' << rgb.b << ", spectral " << spectral.r << ' ' << spectral.g
        << ' ' << spectral.b;
  }
}

// A balance for a light makes this light white and keeps its luminance.
TEST(WhiteBalance, MakesItsLightWhite) {
  const auto colour_of = [](const DenseSpectrum& light) {
    SpectrumCurve curve = SpectrumCurve::tabulated_light(&light);
    return curve.rgb;
  };
  const DenseSpectrum lamp = normalized_luminance(blackbody(2856));
  const DenseSpectrum candle = normalized_luminance(blackbody(1900));
  struct Case {
    const DenseSpectrum* light;
    float kelvin, tolerance;
  };
  for (const Case& c :
       {Case{&lamp, 2856, 2e-3f}, Case{named_spectrum("stdillum-A"), 2856, 5e-3f},
        Case{named_spectrum("stdillum-D50"), 5000, 5e-3f}, Case{named_spectrum("stdillum-D65"), 6500, 5e-3f}}) {
    const Rgb white = white_balance(c.kelvin, ColorSpace::srgb) * colour_of(*c.light);
    EXPECT_NEAR(white.r, 1, c.tolerance) << c.kelvin;
    EXPECT_NEAR(white.g, 1, c.tolerance) << c.kelvin;
    EXPECT_NEAR(white.b, 1, c.tolerance) << c.kelvin;
  }
  // Light warmer than the balance's stays warm.
  const Rgb warm = white_balance(2856, ColorSpace::srgb) * colour_of(candle);
  EXPECT_GT(warm.r, 1.1f);
  EXPECT_LT(warm.b, 0.8f);
  // The two formulas for daylight agree at 7000 K.
  const RgbMatrix below = white_balance(6995, ColorSpace::srgb), above = white_balance(7005, ColorSpace::srgb);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(below.rows[i].r, above.rows[i].r, 1e-3f);
}

}  // namespace
}  // namespace lanthorn::spectrum_test
