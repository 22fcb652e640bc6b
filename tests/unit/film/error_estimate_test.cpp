// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "film/error_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace lanthorn::error_estimate_test {
namespace {

constexpr int width = 96, height = 80;
using Field = std::function<double(int x, int y)>;

Image image() { return {width, height, {"R", "G", "B"}}; }
template <class Value>
void fill(Image& picture, Value&& value) {
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) picture.at(x, y, c) = static_cast<float>(value(x, y, c));
}

double white(int /*x*/, int /*y*/) { return 1; }
// A dim room with a lamp 60 times as bright as its surroundings.
bool is_in_lamp(int x, int y) { return x >= 40 && x < 60 && y >= 20 && y < 30; }
double lamp(int x, int y) { return is_in_lamp(x, y) ? 25 : 0.4; }

// Pictures of `truth` plus noise with a standard deviation of `sigma` per pass. `noise(rng)` makes a field of unit
// variance.
struct Picture {
  PictureHalves halves;
  Image truth = image();

  template <class Noise>
  Picture(const Field& true_value, const Field& sigma, std::array<std::uint64_t, 2> passes, unsigned seed,
          Noise&& noise) {
    std::mt19937 rng(seed);
    fill(truth, [&](int x, int y, std::size_t) { return true_value(x, y); });
    halves.passes = passes;
    halves.picture = image();
    const double all = static_cast<double>(passes[0] + passes[1]);
    for (std::size_t h = 0; h < 2; ++h) {
      const auto n = static_cast<double>(passes[h]);
      const std::vector<double> field = noise(rng);
      halves.halves[h].color = image();
      fill(halves.halves[h].color, [&](int x, int y, std::size_t c) {
        const auto i = (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * 3 + c;
        return true_value(x, y) + sigma(x, y) / std::sqrt(n) * field[i];
      });
      for (std::size_t i = 0; i < halves.picture.pixels.size(); ++i)
        halves.picture.pixels[i] += static_cast<float>(n / all) * halves.halves[h].color.pixels[i];
    }
  }

  double true_error() const {
    double mean = 0, sum = 0;
    for (const float r : truth.pixels) mean += static_cast<double>(r);
    mean /= static_cast<double>(truth.pixels.size());
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
      const auto r = static_cast<double>(truth.pixels[i]), a = static_cast<double>(halves.picture.pixels[i]);
      sum += std::min(1.0, (a - r) * (a - r) / (r * r + 0.01 * mean * mean));
    }
    return std::sqrt(sum / static_cast<double>(truth.pixels.size()));
  }
};

std::vector<double> independent(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  std::vector<double> field(std::size_t{width} * height * 3);
  for (double& value : field) value = normal(rng);
  return field;
}
// Constant in blocks of 8 x 8 pixels, like the noise of a wide kernel.
std::vector<double> in_blocks(std::mt19937& rng) {
  std::vector<double> field = independent(rng);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        field[(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * 3 + c] =
            field[(static_cast<std::size_t>(y / 8 * 8) * width + static_cast<std::size_t>(x / 8 * 8)) * 3 + c];
  return field;
}

// Ratio of estimated and true error, averaged over pictures, and how often the bound holds.
struct Tried {
  double ratio = 0, kept = 0, margin = 0;
};
template <class Noise>
Tried try_pictures(const Field& truth, const Field& sigma, Noise&& noise) {
  constexpr unsigned count = 60;
  Tried tried;
  for (unsigned seed = 0; seed < count; ++seed) {
    const Picture picture(truth, sigma, {24, 40}, seed, noise);
    const ErrorEstimate e = measure_error(picture.halves).estimate;
    EXPECT_EQ(e.doubt, "");
    tried.ratio += e.error / picture.true_error() / count;
    tried.kept += (picture.true_error() <= e.bound ? 1.0 : 0.0) / count;
    tried.margin += e.bound / e.error / count;
  }
  return tried;
}

TEST(ErrorEstimate, EvenNoiseIsMeasured) {
  const Tried tried = try_pictures(
      white, [](int, int) { return 0.5; }, independent);
  EXPECT_NEAR(tried.ratio, 1, 0.03);
  EXPECT_GE(tried.kept, 0.8);
  EXPECT_LT(tried.margin, 1.03) << "many pixels make it certain";
}

// Only edges of a lamp, whose pixels mix both sides, have the largest variance.
TEST(ErrorEstimate, NoiseOfEdgesStaysThere) {
  const Field sigma = [](int x, int y) {
    const bool is_edge = is_in_lamp(x, y) && !(is_in_lamp(x - 1, y) && is_in_lamp(x + 1, y) && is_in_lamp(x, y - 1) &&
                                               is_in_lamp(x, y + 1));
    return is_edge ? 12.0 : 0.1;
  };
  const Tried tried = try_pictures(lamp, sigma, independent);
  EXPECT_NEAR(tried.ratio, 1, 0.15);
}

// Squares of two brightnesses, so that every pixel is near an edge. The dark ones alone have noise: their pixels belong
// to dark corners, whatever the bright ones beside them look like.
TEST(ErrorEstimate, PixelsNearEdgesBelongToTheirOwnSide) {
  const auto is_dark = [](int x, int y) { return (x / 12 + y / 12) % 2 == 0; };
  const Tried tried = try_pictures([&](int x, int y) { return is_dark(x, y) ? 0.5 : 4.0; },
                                   [&](int x, int y) { return is_dark(x, y) ? 0.5 : 0.01; }, independent);
  EXPECT_NEAR(tried.ratio, 1, 0.05);
}

// Noise only in a corner of the picture.
TEST(ErrorEstimate, NoiseOfAPartIsMeasured) {
  const Tried tried = try_pictures(
      white, [](int x, int y) { return x < 24 && y < 20 ? 1.0 : 0.01; }, independent);
  EXPECT_NEAR(tried.ratio, 1, 0.05);
  EXPECT_GE(tried.kept, 0.8);
}

// Most pixels of a half have no bright path, some have one or two. Between stripes, no surroundings are alike: the true
// value is estimated from the pixel itself, which such a path makes too bright.
std::vector<double> rare_bright_paths(std::mt19937& rng) {
  constexpr double mean = 0.3;
  std::poisson_distribution<int> number(mean);
  std::vector<double> field(std::size_t{width} * height * 3);
  for (double& value : field) value = (number(rng) - mean) / std::sqrt(mean);
  return field;
}
TEST(ErrorEstimate, BrightPathsDoNotHideBehindTheirOwnLight) {
  const Field stripes = [](int x, int) { return x % 2 == 0 ? 1.0 : 4.0; };
  const Tried tried = try_pictures(
      stripes, [&](int x, int y) { return 0.5 * std::sqrt(32) * stripes(x, y); }, rare_bright_paths);
  EXPECT_NEAR(tried.ratio, 1, 0.06);
}

// The estimate is equally good, but less certain.
TEST(ErrorEstimate, CorrelatedNoiseWidensTheBound) {
  const Tried tried = try_pictures(
      white, [](int, int) { return 0.5; }, in_blocks);
  EXPECT_NEAR(tried.ratio, 1, 0.06);
  EXPECT_GE(tried.kept, 0.8);
  EXPECT_GT(tried.margin, 1.04);
}

TEST(ErrorEstimate, DoesNotDependOnExposure) {
  const auto estimate = [](double exposure) {
    const Picture picture([&](int x, int y) { return exposure * lamp(x, y); }, [&](int, int) { return 0.2 * exposure; },
                          {24, 40}, 5, independent);
    return measure_error(picture.halves).estimate.bound;
  };
  EXPECT_NEAR(estimate(1000) / estimate(1), 1, 1e-4);
}

TEST(ErrorEstimate, FewPassesAreNoMeasure) {
  const auto doubt = [](std::array<std::uint64_t, 2> passes) {
    const Picture picture(
        white, [](int, int) { return 0.1; }, passes, 1, independent);
    const MeasuredError measured = measure_error(picture.halves);
    EXPECT_EQ(measured.standard_error.pixels.size(), picture.truth.pixels.size());
    EXPECT_FALSE(measured.estimate.is_below(1));
    return measured.estimate.doubt;
  };
  EXPECT_EQ(doubt({4, 0}), "there are too few passes");
  EXPECT_EQ(doubt({4, 1}), "there are too few passes");
}

// Nothing can be said relative to no light. A render that stops at an error ends all the same.
TEST(ErrorEstimate, BlackPicturesHaveNoKnownError) {
  const auto none = [](int, int) { return 0.0; };
  const ErrorEstimate black = measure_error(Picture(none, none, {2, 2}, 1, independent).halves).estimate;
  EXPECT_FALSE(black.is_known());
  EXPECT_EQ(describe_error(black), "not known: the picture is black");
  EXPECT_TRUE(black.is_below(0.01));
  EXPECT_EQ(black.bound, 1);
  EXPECT_FALSE(measure_error(Picture(none, none, {1, 1}, 1, independent).halves).estimate.is_below(0.01));
  // One pixel with light is enough.
  const auto spot = [](int x, int y) { return x == 3 && y == 4 ? 1.0 : 0.0; };
  EXPECT_EQ(describe_error(measure_error(Picture(spot, none, {2, 2}, 1, independent).halves).estimate), "0 %");
}

TEST(ErrorEstimate, PicturesWithoutNoiseHaveNoError) {
  const ErrorEstimate even = measure_error(Picture(
                                               white, [](int, int) { return 0.0; }, {2, 2}, 1, independent)
                                               .halves)
                                 .estimate;
  EXPECT_TRUE(even.is_below(0.01));
  EXPECT_EQ(describe_error(even), "0 %");
}

// One pixel in 400 contains a path that carries all the light.
std::vector<double> spikes(std::mt19937& rng) {
  std::vector<double> field(std::size_t{width} * height * 3);
  for (std::size_t i = 0; i < field.size(); i += 3)
    if (rng() % 400 == 0) field[i] = field[i + 1] = field[i + 2] = 300;
  return field;
}
TEST(ErrorEstimate, LightInSpikesIsNoMeasure) {
  const Picture picture([](int, int) { return 0.01; }, [](int, int) { return 1.0; }, {24, 40}, 1, spikes);
  EXPECT_NE(measure_error(picture.halves).estimate.doubt.find("of the light is in single bright pixels"),
            std::string::npos);
}

// In each half, the noise of the bias far exceeds the bias itself.
TEST(ErrorEstimate, BiasIsFoundUnderNoise) {
  constexpr double bias = 0.05;
  double mean = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    Picture picture(
        white, [](int, int) { return 0.1; }, {24, 40}, seed, independent);
    std::mt19937 rng(seed + 1000);
    std::normal_distribution<double> noise(-bias, 0.3);
    for (HalfPicture& half : picture.halves.halves) {
      half.bias = image();
      fill(half.bias, [&](int, int, std::size_t) { return noise(rng); });
    }
    const MeasuredError measured = measure_error(picture.halves);
    mean += measured.estimate.bias / 10;
    EXPECT_LT(measured.bias.at(40, 40, 1), 0) << "the picture is too dark";
    EXPECT_NEAR(measured.estimate.error, std::hypot(measured.estimate.noise, measured.estimate.bias), 1e-12);
  }
  EXPECT_NEAR(mean, bias / std::sqrt(1.01), 0.003);
}

TEST(ErrorEstimate, GrowthReachesTheBound) {
  ErrorEstimate e;
  e.noise = e.error = e.bound = 0.04;
  EXPECT_NEAR(growth_to_reach(e, 0.02), 4, 0.01);
  EXPECT_EQ(growth_to_reach(e, 0.05), 1);
  e.noise = 0;
  e.bias = 0.04;
  EXPECT_NEAR(growth_to_reach(e, 0.02), 8, 0.02);
}

}  // namespace
}  // namespace lanthorn::error_estimate_test
