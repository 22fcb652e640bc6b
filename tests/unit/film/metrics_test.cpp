// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "lanthorn/error.h"
#include "lanthorn/flip.h"

namespace lanthorn::metrics_test {
namespace {

Image constant(int width, int height, const std::vector<float>& rgb) {
  Image image(width, height, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = rgb[i % 3];
  return image;
}

/// A smooth picture. If `disturbed`, every fifth diagonal has half the value.
Image ramps(bool disturbed, float scale = 1) {
  Image image(32, 24, {"R", "G", "B"});
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x) {
      const float factor = disturbed && (x + y) % 5 == 0 ? 0.5f * scale : scale;
      image.at(x, y, 0) = factor * (static_cast<float>(x) / 31);
      image.at(x, y, 1) = factor * (static_cast<float>(y) / 23);
      image.at(x, y, 2) = factor * (static_cast<float>(x + y) / 54);
    }
  return image;
}

TEST(ImageErrors, MatchTheirDefinitions) {
  Image a(2, 1, {"Y"}), r(2, 1, {"Y"});
  a.pixels = {3, 0.5f};
  r.pixels = {1, 0};
  const ImageErrors e = image_errors(a, r);
  EXPECT_DOUBLE_EQ(e.mse, (4 + 0.25) / 2);
  EXPECT_DOUBLE_EQ(e.rel_mse, (4 / 1.01 + 0.25 / 0.01) / 2);
  EXPECT_DOUBLE_EQ(e.mean_ratio.value(), 3.5);
  EXPECT_DOUBLE_EQ(e.max_difference, 2);
  EXPECT_DOUBLE_EQ(image_errors(a, r, {.epsilon = 1, .rel_clamp = 1.0}).rel_mse, (1 + 0.25) / 2);
  EXPECT_FALSE(image_errors(r, Image(2, 1, {"Y"})).mean_ratio);
  EXPECT_THROW(image_errors(a, Image(1, 2, {"Y"})), Error);
  EXPECT_THROW(image_errors(a, Image(2, 1, {"Y", "A"})), Error);
}

TEST(ImageErrors, CountNonFiniteValues) {
  Image a(3, 1, {"Y"}), r(3, 1, {"Y"});
  a.pixels = {NAN, 1, 2};
  r.pixels = {0, INFINITY, 1};
  const ImageErrors e = image_errors(a, r);
  EXPECT_EQ(e.non_finite, 2u);
  EXPECT_DOUBLE_EQ(e.mse, 1);
}

TEST(StudentT, MatchesTables) {
  // Two-sided 5 % and 0.1 % points from the usual tables, and closed forms for 1 and 2 degrees of freedom.
  EXPECT_NEAR(student_t_p_value(12.706, 1), 0.05, 1e-5);
  EXPECT_NEAR(student_t_p_value(4.303, 2), 0.05, 1e-5);
  EXPECT_NEAR(student_t_p_value(2.228, 10), 0.05, 1e-4);
  EXPECT_NEAR(student_t_p_value(-4.587, 10), 0.001, 1e-5);
  EXPECT_NEAR(student_t_p_value(3.291, 1e7), 0.001, 1e-5);
  for (const double t : {0.1, 1.0, 30.0, 1e4}) {
    EXPECT_NEAR(student_t_p_value(t, 1), 2 / M_PI * std::atan2(1, t), 1e-13) << t;
    EXPECT_NEAR(student_t_p_value(t, 2), 2 / (2 + t * t + t * std::sqrt(2 + t * t)), 1e-13) << t;
  }
  EXPECT_EQ(student_t_p_value(0, 3.3), 1);
}

/// `base` plus normal noise of the given standard deviation per pixel.
std::vector<Image> noisy_runs(const Image& base, float deviation, std::size_t count, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> noise(0, deviation);
  std::vector<Image> runs(count, base);
  for (Image& run : runs)
    for (float& value : run.pixels) value += noise(rng);
  return runs;
}

TEST(Agreement, AcceptsNoiseAndRejectsBias) {
  const Image truth = constant(64, 64, {0.5f, 0.4f, 0.3f});
  const Image sem = constant(64, 64, {0.02f, 0.02f, 0.02f});
  const Image reference = noisy_runs(truth, 0.02f, 1, 1)[0];
  // The image's mean has a standard error of 0.06 %, means of tiles have 1 %.
  EXPECT_TRUE(agreement_with_reference(reference, sem, noisy_runs(truth, 0.05f, 4, 2)).agrees);
  const Image brighter = constant(64, 64, {0.51f, 0.408f, 0.306f});
  const Agreement biased = agreement_with_reference(reference, sem, noisy_runs(brighter, 0.05f, 4, 3));
  EXPECT_FALSE(biased.agrees);
  EXPECT_NEAR(biased.mean_difference, 0.02, 0.003);

  Image local = truth;  // a blot in 9 of 64 tiles that leaves the mean unchanged
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 48; ++x)
      for (std::size_t c = 0; c < 3; ++c) local.at(x, y, c) *= x < 24 ? 1.3f : 0.7f;
  const Agreement blot = agreement_with_reference(reference, sem, noisy_runs(local, 0.05f, 4, 4));
  EXPECT_FALSE(blot.agrees);
  EXPECT_NEAR(blot.outliers, 18.0 / 64, 1e-6);
  EXPECT_LT(std::fabs(blot.mean_difference), 0.01);
}

TEST(Agreement, MatchesTheConformanceScript) {
  // Against check.py of the conformance suite, on the same numbers: deterministic "noise", three runs, incomplete
  // tiles.
  const auto picture = [](int seed) {
    Image image(19, 17, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] =
          0.5f + static_cast<float>((i * 37 + static_cast<std::size_t>(seed) * 101 + i * i % 13) % 64) / 256;
    return image;
  };
  const Agreement a = agreement_with_reference(picture(0), constant(19, 17, {0.03f, 0.03f, 0.03f}),
                                               std::vector<Image>{picture(1), picture(2), picture(5)});
  EXPECT_TRUE(a.agrees);
  EXPECT_NEAR(a.mean_difference, -0.0039950387697886, 1e-7);
  EXPECT_NEAR(a.mean_error, 0.002327368047271099, 1e-7);
  EXPECT_EQ(a.outliers, 0);
  EXPECT_NEAR(a.rel_mse, 9.146607130804689e-05, 1e-9);
}

TEST(Agreement, NeedsTwoRunsAndATile) {
  const Image image = constant(8, 8, {1, 1, 1});
  EXPECT_THROW(agreement_with_reference(image, image, std::vector<Image>{image}), Error);
  const Image small = constant(7, 8, {1, 1, 1});
  EXPECT_THROW(agreement_with_reference(small, small, std::vector<Image>{small, small}), Error);
}

TEST(Welch, HasItsFalseAlarmRate) {
  // 400 comparisons without a difference: p < 0.05 is expected in 20 of them, sd 4.4. Outside 4 sd: 6e-5.
  int alarms = 0;
  for (unsigned i = 0; i < 400; ++i) {
    const Image truth = constant(16, 16, {0.5f, 1, 2});
    alarms += welch_tile_test(noisy_runs(truth, 0.1f, 3, 2 * i), noisy_runs(truth, 0.3f, 5, 2 * i + 1)).p < 0.05;
  }
  EXPECT_NEAR(alarms, 20, 4 * 4.4);
}

TEST(Welch, MatchesItsFormula) {
  const auto runs = [](const std::vector<float>& values) {
    std::vector<Image> images;
    for (const float value : values) {
      images.emplace_back(8, 8, std::vector<std::string>{"Y"});
      std::fill(images.back().pixels.begin(), images.back().pixels.end(), value);
    }
    return images;
  };
  // Means 7/3 and 11/2, squared errors of the means 7/9 and 13/12.
  const double t = (7.0 / 3 - 5.5) / std::sqrt(7.0 / 9 + 13.0 / 12);
  const double degrees = std::pow(7.0 / 9 + 13.0 / 12, 2) / (std::pow(7.0 / 9, 2) / 2 + std::pow(13.0 / 12, 2) / 3);
  EXPECT_NEAR(welch_tile_test(runs({1, 2, 4}), runs({3, 5, 6, 8})).p, student_t_p_value(t, degrees), 1e-12);
}

TEST(Welch, FindsADifferenceAndItsPlace) {
  const Image truth = constant(32, 16, {0.5f, 1, 2});
  Image other = truth;
  for (int y = 8; y < 16; ++y)
    for (int x = 16; x < 24; ++x) other.at(x, y, 1) += 0.2f;
  const Comparison c = welch_tile_test(noisy_runs(truth, 0.1f, 6, 1), noisy_runs(other, 0.1f, 6, 2));
  EXPECT_LT(c.p, 1e-4);
  EXPECT_EQ(c.tests, 24u);
  EXPECT_EQ(c.tile_x, 2);
  EXPECT_EQ(c.tile_y, 1);
  EXPECT_EQ(c.channel, 1u);
}

TEST(Welch, KnowsPicturesWithoutNoise) {
  const std::vector<Image> a(2, constant(8, 8, {1, 1, 1})), b(2, constant(8, 8, {1, 1.0001f, 1}));
  EXPECT_EQ(welch_tile_test(a, a).p, 1);
  EXPECT_EQ(welch_tile_test(a, b).p, 0);
}

TEST(Flip, IsZeroForEqualPicturesAndSymmetric) {
  EXPECT_EQ(ldr_flip(ramps(true), ramps(true)).mean, 0);
  EXPECT_EQ(hdr_flip(ramps(true), ramps(true)).mean, 0);
  EXPECT_EQ(ldr_flip(ramps(false), ramps(true)).map, ldr_flip(ramps(true), ramps(false)).map);
}

// Uniform pictures have no features and nothing for the eye to blur, so that FLIP is the redistributed HyAB distance: 1
// for green and blue, which span its scale, and computed by hand for black and white, whose L* differs by 100.
TEST(Flip, OfUniformPicturesIsTheColorDifference) {
  const Image green = constant(8, 8, {0, 1, 0}), blue = constant(8, 8, {0, 0, 1});
  EXPECT_NEAR(ldr_flip(green, blue).mean, 1, 1e-5);
  const double largest = std::pow(203.27, 0.7), knee = 0.4 * largest;
  const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - knee) / (largest - knee);
  EXPECT_NEAR(ldr_flip(constant(8, 8, {0, 0, 0}), constant(8, 8, {1, 1, 1})).mean, expected, 1e-4);
  EXPECT_NEAR(expected, 0.96738, 1e-4);
}

// Expected values are from a direct (not separable) double-precision transcription of the paper, whose constants were
// checked against the authors' code.
TEST(Flip, MatchesADirectEvaluation) {
  const FlipResult flip = ldr_flip(ramps(true), ramps(false));
  EXPECT_NEAR(flip.mean, 0.206160832, 2e-6);
  EXPECT_NEAR(flip.map[3 * 32 + 4], 0.0930339294, 2e-5);
  EXPECT_NEAR(flip.map[20 * 32 + 30], 0.261373559, 2e-5);
  EXPECT_NEAR(flip.map[12 * 32], 0.157667408, 2e-5);
  const FlipResult hdr = hdr_flip(ramps(true, 8), ramps(false, 8));
  EXPECT_NEAR(hdr.mean, 0.145164605, 2e-6);
  EXPECT_NEAR(hdr.map[20 * 32 + 30], 0.141168815, 2e-5);
  // 15 stops from left to right, so that several exposures are needed.
  Image wide = ramps(true), wide_reference = ramps(false);
  for (Image* image : {&wide, &wide_reference})
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 32; ++x)
        for (std::size_t c = 0; c < 3; ++c) image->at(x, y, c) *= std::exp2(static_cast<float>(x - 16) / 2);
  const FlipResult wide_flip = hdr_flip(wide, wide_reference);
  EXPECT_NEAR(wide_flip.mean, 0.156392263, 2e-6);
  EXPECT_NEAR(wide_flip.map[20 * 32 + 3], 0.118855422, 2e-5);
  EXPECT_NEAR(wide_flip.map[20 * 32 + 30], 0.155458039, 2e-5);
}

TEST(Flip, OfHighDynamicRangeDoesNotDependOnExposure) {
  EXPECT_NEAR(hdr_flip(ramps(true, 64), ramps(false, 64)).mean, hdr_flip(ramps(true), ramps(false)).mean, 1e-5);
}

// The exposures follow from the pixels that are not black: a frame of black around a picture changes nothing far
// inside.
TEST(Flip, ExposuresOfAMostlyBlackPictureAreThoseOfItsLight) {
  constexpr int light = 64, frame = 80;
  const auto ramp = [](int border, float scale) {
    Image image(light + 2 * border, light + 2 * border, {"R", "G", "B"});
    for (int y = 0; y < light; ++y)
      for (int x = 0; x < light; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          image.at(x + border, y + border, c) = scale * (0.05f + static_cast<float>(x * x * (y + 9)));
    return image;
  };
  const FlipResult alone = hdr_flip(ramp(0, 1.2f), ramp(0, 1)), framed = hdr_flip(ramp(frame, 1.2f), ramp(frame, 1));
  const auto at = [](int border, int x, int y) {
    return static_cast<std::size_t>((y + border) * (light + 2 * border) + x + border);
  };
  for (int y = 28; y < 36; ++y)
    for (int x = 28; x < 36; ++x) EXPECT_NEAR(framed.map[at(frame, x, y)], alone.map[at(0, x, y)], 1e-6f);
}

TEST(Flip, TakesAnyValues) {
  Image wild = ramps(false);
  wild.pixels[5] = NAN;
  wild.pixels[50] = INFINITY;
  wild.pixels[500] = -3e38f;
  wild.pixels[600] = 3e38f;
  for (const FlipResult& flip :
       {hdr_flip(wild, ramps(false)), hdr_flip(ramps(false), wild), ldr_flip(wild, ramps(false)),
        hdr_flip(constant(4, 4, {0, 0, 0}), constant(4, 4, {0, 0, 0}))})
    EXPECT_TRUE(std::all_of(flip.map.begin(), flip.map.end(), [](float e) { return e >= 0 && e <= 1; }));
  EXPECT_THROW(ldr_flip(wild, constant(8, 8, {0, 0, 0})), Error);
  EXPECT_THROW(ldr_flip(Image(2, 2, {"depth.Z"}), Image(2, 2, {"depth.Z"})), Error);
}

TEST(Layers, AreFoundByName) {
  Image image(1, 1,
              {"B", "G", "R", "A", "direct.R", "direct.G", "direct.B", "normal.X", "normal.Y", "normal.Z", "depth.Z",
               "samples"});
  std::iota(image.pixels.begin(), image.pixels.end(), 0.0f);
  EXPECT_EQ(layer_names(image), (std::vector<std::string>{"color", "direct", "normal", "depth", "samples"}));
  EXPECT_EQ(select_layer(image, "color")->pixels, (std::vector<float>{2, 1, 0}));
  EXPECT_EQ(select_layer(image, "normal")->pixels, (std::vector<float>{7, 8, 9}));
  EXPECT_EQ(select_layer(image, "depth")->pixels, (std::vector<float>{10}));
  EXPECT_EQ(select_layer(image, "samples")->pixels, (std::vector<float>{11}));
  EXPECT_FALSE(select_layer(image, "caustic"));
  Image grey(1, 1, {"Y"});
  grey.pixels = {3};
  EXPECT_EQ(select_layer(grey, "color")->pixels, (std::vector<float>{3, 3, 3}));
}

}  // namespace
}  // namespace lanthorn::metrics_test
