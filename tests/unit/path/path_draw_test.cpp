// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/path_draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
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

// The colour of a reflectance under D65 as the film has it after a number of passes, without noise.
Rgb mean_colour(std::uint64_t seed, std::uint32_t passes, float (*reflectance)(float)) {
  Rgb sum;
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    const Wavelengths w = wavelengths_in_order(seed, ColorMode::spectral, pass, false);
    Spectrum light;
    for (unsigned i = 0; i < 4; ++i) light.v[i] = reflectance(w.lambda[i]) * illuminant_d65.at(w.lambda[i]);
    sum += (1 / static_cast<float>(passes)) * w.to_rgb(light);
  }
  return sum;
}

// With jittered offsets, as paths have them, errors would be up to .3, .13 and .05.
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

// The colours of illuminant D65 in these passes: from the hero wavelengths alone, as behind dispersive glass, and from
// all wavelengths.
struct White {
  Rgb heroes, all;
};
White white_of(std::uint64_t seed, std::uint32_t first, std::uint32_t passes) {
  White white;
  for (std::uint32_t pass = first; pass < first + passes; ++pass) {
    const Wavelengths w = wavelengths_in_order(seed, ColorMode::spectral, pass, true);
    Spectrum light;
    for (unsigned i = 0; i < 4; ++i) light.v[i] = illuminant_d65.at(w.lambda[i]);
    white.all += w.to_rgb(light);
    white.heroes += w.to_rgb(light * w.dispersed);
  }
  return white;
}

// The red component of light with equal power at all wavelengths.
double red_of_white(ColorMode mode) {
  constexpr std::uint32_t many = 4096;
  double sum = 0;
  for (std::uint32_t number = 0; number < many; ++number) {
    const Wavelengths w = wavelengths_in_order(0, mode, number, true);
    sum += static_cast<double>(w.to_rgb(Spectrum(1) * w.dispersed).r) / many;
  }
  return sum;
}

// After 32 passes, i.e. sixteen of two sets each, and after any multiple, whatever the order of a block's sets.
TEST(WavelengthsOfPass, WhatDispersesIsWhiteAfterThirtyTwo) {
  for (std::uint64_t seed = 0; seed < 32; ++seed)
    for (const std::uint32_t block : {0u, 1u, 5u}) {
      const White white = white_of(seed, 32 * block, 32);
      EXPECT_NEAR(white.heroes.r / white.all.r, 1, 2e-3) << seed;
      EXPECT_NEAR(white.heroes.g / white.all.g, 1, 2e-3) << seed;
      EXPECT_NEAR(white.heroes.b / white.all.b, 1, 2e-3) << seed;
    }
}

// If the hero were chosen at random among four wavelengths, the error after half a block would be .8.
TEST(WavelengthsOfPass, WhatDispersesIsNearlyWhiteBefore) {
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    const White white = white_of(seed, 0, 16);
    EXPECT_NEAR(white.heroes.r / white.all.r, 1, 0.1) << seed;
    EXPECT_NEAR(white.heroes.g / white.all.g, 1, 0.1) << seed;
    EXPECT_NEAR(white.heroes.b / white.all.b, 1, 0.1) << seed;
  }
}

// In eight passes, the heroes lie in eight different eighths of the scale of wavelengths from which `spectral` draws.
TEST(WavelengthsOfPass, HeroesAreSpread) {
  std::vector<float> scale;
  for (int i = 0; i < 4096; ++i)
    scale.push_back(Wavelengths::spectral((static_cast<float>(i) + 0.5f) / 4096).lambda[0]);
  for (std::uint32_t first = 0; first < 64; first += 8) {
    std::vector<double> places;
    for (std::uint32_t pass = first; pass < first + 8; ++pass) {
      const float hero = wavelengths_in_order(3, ColorMode::spectral, pass, true).lambda[0];
      const auto at = std::lower_bound(scale.begin(), scale.end(), hero) - scale.begin();
      places.push_back(static_cast<double>(at) / 4096);
    }
    std::sort(places.begin(), places.end());
    for (std::size_t i = 0; i < 8; ++i) {
      const double gap = i < 7 ? places[i + 1] - places[i] : places[0] + 1 - places[7];
      EXPECT_LT(gap, 0.25) << first;
    }
  }
}

// The difference between the film's halves measures noise, so their colours must differ by as much as their mean is
// wrong. When both halves shared a sequence, they differed by up to ten times as much. In spectral mode, passes have
// two parts.
TEST(WavelengthsOfPass, HalvesDifferAsMuchAsTheirMeanIsWrong) {
  for (const auto& [mode, parts] : {std::pair{ColorMode::rgb, 1u}, {ColorMode::spectral, 2u}})
    for (const std::uint32_t passes : {16u, 64u}) {
      double error = 0, difference = 0;
      for (std::uint64_t seed = 0; seed < 256; ++seed) {
        std::array<float, 2> red{};
        for (std::uint32_t number = 0; number < passes * parts; ++number) {
          const PlaceInHalf place = place_in_half(number, parts);
          const Wavelengths w = wavelengths_of_pass(seed, mode, place, true);
          red[static_cast<std::size_t>(place.half)] += w.to_rgb(Spectrum(1) * w.dispersed).r;
        }
        const auto half = 0.5 * passes * parts;
        const double a = static_cast<double>(red[0]) / half, b = static_cast<double>(red[1]) / half;
        error += sqr((a + b) / 2 - red_of_white(mode));
        difference += sqr((a - b) / 2);
      }
      EXPECT_NEAR(std::sqrt(difference / error), 1, 0.3) << parts << ' ' << passes;
    }
}

// Moving and dispersed light in 32 passes of two parts: each quarter of the shutter interval gets each of the eight
// offsets, from either half, and each quarter of the heroes.
TEST(WavelengthsOfPass, ColoursDoNotFollowTime) {
  constexpr std::uint32_t parts = 2;
  std::set<std::pair<int, int>> met, heroes;
  for (const FilmHalf half : {FilmHalf::first, FilmHalf::second}) {
    std::set<std::pair<float, int>> lowest;  // wavelength, and a quarter that has it
    for (std::uint32_t number = 0; number < 32 * parts; ++number) {
      const PlaceInHalf place = place_in_half(number, parts);
      if (place.half != half) continue;
      const auto quarter = static_cast<int>(4 * shutter_part(0, number).begin);
      const Wavelengths w = wavelengths_of_pass(0, ColorMode::spectral, place, true);
      std::array<float, 4> sorted = w.lambda;
      std::sort(sorted.begin(), sorted.end());
      heroes.insert({quarter, static_cast<int>(std::find(sorted.begin(), sorted.end(), w.lambda[0]) - sorted.begin())});
      lowest.insert({std::round(sorted[0]), quarter});
    }
    int offset = -1;
    float before = 0;
    for (const auto& [wavelength, quarter] : lowest) {
      if (wavelength != before) ++offset;
      before = wavelength;
      met.insert({quarter, offset});
    }
  }
  EXPECT_EQ(heroes.size(), 16u);
  EXPECT_EQ(met.size(), 32u);
}

// The four pixels of a square have four heroes, so that even a small part of a pass has the colour of all.
TEST(HeroesOfPaths, EachSquareOfPixelsHasAll) {
  std::set<unsigned> of_corner;
  for (int y = 0; y < 32; y += 2)
    for (int x = 0; x < 32; x += 2) {
      const std::set<unsigned> heroes{hero_of_pixel(x, y), hero_of_pixel(x + 1, y), hero_of_pixel(x, y + 1),
                                      hero_of_pixel(x + 1, y + 1)};
      EXPECT_EQ(heroes, (std::set<unsigned>{0, 1, 2, 3}));
      of_corner.insert(hero_of_pixel(x, y));
    }
  EXPECT_EQ(of_corner.size(), 4u) << "no pattern that repeats";
}

TEST(HeroesOfPaths, LightPathsHaveAllEquallyOften) {
  const Wavelengths w = Wavelengths::spectral(0.1f);
  for (const float length : {0.0f, 1.0f}) {
    const PassDraw draw{0, length, w, true};
    std::array<int, 4> count{};
    for (std::uint32_t path = 0; path < 4096; ++path) {
      Sampler sampler = Sampler::for_light_path(0, Stream::light, 0, 0, path);
      const Wavelengths own = draw.of_path(sampler).w;
      EXPECT_EQ(own.lambda, w.lambda);
      EXPECT_EQ(own.dispersed.v[own.hero], 4);
      ++count[own.hero];
    }
    EXPECT_EQ(count, (std::array<int, 4>{1024, 1024, 1024, 1024})) << length;
  }
}

// The mean over the heroes of both paths, whichever of them is dispersed.
TEST(HeroesOfPaths, LightThatMeetsKeepsItsMean) {
  const Wavelengths w = Wavelengths::spectral(0.1f);
  const Spectrum light(0.5f, 1, 2, 3);
  for (const bool of_light : {false, true})
    for (const bool of_eye : {false, true}) {
      Spectrum mean;
      for (unsigned hero_of_light = 0; hero_of_light < 4; ++hero_of_light)
        for (unsigned hero_of_eye = 0; hero_of_eye < 4; ++hero_of_eye) {
          const LightToMeet kept = LightToMeet::of(light, of_light, w.with_hero(hero_of_light));
          const bool is_dispersed = of_eye || kept.dispersed;
          mean += 0.0625f * (is_dispersed ? kept.light * w.with_hero(hero_of_eye).dispersed : kept.light);
        }
      EXPECT_EQ(mean, light) << of_light << of_eye;
    }
  EXPECT_TRUE(LightToMeet::of(light, true, Wavelengths::rgb(0.5f)).dispersed);
}

}  // namespace
}  // namespace lanthorn::path_draw_test
