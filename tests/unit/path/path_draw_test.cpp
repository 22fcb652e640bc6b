// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/path_draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "spectrum/cie.h"

namespace lanthorn::path_draw_test {
namespace {

std::vector<float> begins(std::uint64_t seed, std::uint32_t first, std::uint32_t count, float length) {
  std::vector<float> result;
  for (std::uint32_t pass = first; pass < first + count; ++pass) {
    const ShutterPart part = shutter_part(seed, pass);
    EXPECT_EQ(part.length, length);
    result.push_back(part.begin);
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(ShutterPart, SixteenPassesCoverTheIntervalAndTheNextInQuarters) {
  for (const std::uint64_t seed : {0, 7}) {
    const std::vector<float> first = begins(seed, 0, 16, 1.0f / 16), next = begins(seed, 16, 64, 1.0f / 64);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(first[i], static_cast<float>(i) / 16);
    for (std::size_t i = 0; i < 64; ++i) EXPECT_EQ(next[i], static_cast<float>(i) / 64);
  }
}

TEST(ShutterPart, FewPassesAreSpreadOverTheInterval) {
  const std::vector<float> first = begins(3, 0, 4, 1.0f / 16);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(static_cast<std::size_t>(4 * first[i]), i);
}

// The colour of a reflectance under D65 as the film has it after these passes, without noise.
Rgb mean_colour(std::uint64_t seed, std::uint32_t passes, float (*reflectance)(float)) {
  Rgb sum;
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    const Wavelengths w = wavelengths_of_pass(seed, ColorMode::spectral, pass);
    Spectrum light;
    for (unsigned i = 0; i < 4; ++i) light.v[i] = reflectance(w.lambda[i]) * illuminant_d65.at(w.lambda[i]);
    sum += (1 / static_cast<float>(passes)) * w.to_rgb(light);
  }
  return sum;
}

// Jittered offsets, as paths have, are off by up to .3, .13 and .05.
TEST(WavelengthsOfPass, PassesSoonMeanTheirColour) {
  const auto white = [](float) { return 1.0f; };
  const auto red = [](float lambda) { return 0.1f + 0.6f / (1 + std::exp((600 - lambda) / 15)); };
  const auto green = [](float lambda) { return 0.1f + 0.5f * std::exp(-sqr((lambda - 540) / 40)); };
  for (const std::uint64_t seed : {0, 1, 2, 3, 4, 5, 6, 7})
    for (float (*reflectance)(float) : {+white, +red, +green}) {
      const Rgb right = mean_colour(seed, 1024, reflectance);
      const auto error = [&](std::uint32_t passes) {
        const Rgb found = mean_colour(seed, passes, reflectance);
        return std::max({std::fabs(found.r - right.r), std::fabs(found.g - right.g), std::fabs(found.b - right.b)});
      };
      EXPECT_LT(error(4), 0.04f) << seed;
      EXPECT_LT(error(8), 0.012f) << seed;
      EXPECT_LT(error(16), 0.01f) << seed;
    }
}

TEST(WavelengthsOfPass, FourPassesHaveTheirHeroesInFourQuarters) {
  for (std::uint32_t block = 0; block < 64; ++block) {
    std::set<int> quarters;  // by the order of the four wavelengths, of which the hero is the first
    for (std::uint32_t pass = 4 * block; pass < 4 * block + 4; ++pass) {
      const Wavelengths w = wavelengths_of_pass(1, ColorMode::spectral, pass);
      quarters.insert(static_cast<int>(
          std::count_if(w.lambda.begin(), w.lambda.end(), [&](float lambda) { return lambda < w.lambda[0]; })));
    }
    EXPECT_EQ(quarters.size(), 4u) << block;
  }
}

}  // namespace
}  // namespace lanthorn::path_draw_test
