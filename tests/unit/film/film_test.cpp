// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "film/film_pass.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "film/display.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/image_file.h"
#include "support/error_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::film_test {
namespace {

// Four layers of light, as most methods have.
constexpr std::size_t emission = 0, direct = 1, indirect = 2, caustic = 3;
constexpr std::size_t first_splats =
    3 * 4 + feature_channels + 2;  // plane index in a film without bias layers: after light, features, hits, weights
const std::vector<std::string> layers{"emission", "direct", "indirect", "caustic"};
const Decomposition techniques{{"technique.hit", "technique.nee", "technique.vc", "technique.vm"},
                               "technique.splat",
                               Decomposition::Shares{"technique.share", {{{3}, {2, 1, 4}, {0}}}}};

constexpr int width = 7, height = 5;
constexpr std::uint32_t pixels = width * height;

Rgb random_rgb(std::mt19937& rng, float scale) {
  // Magnitudes over 30 binary orders: far below one step, and far above.
  const auto value = [&] { return scale * std::exp2(-30 * std::generate_canonical<float, 24>(rng)); };
  const float r = value(), g = value();
  return {r, g, -value()};
}

PixelSample random_sample(std::mt19937& rng) {
  PixelSample s;
  s.light[emission] = random_rgb(rng, 50);
  s.light[direct] = random_rgb(rng, 1);
  s.light[indirect] = random_rgb(rng, 1e-6f);
  s.light[caustic] = random_rgb(rng, 200);
  s.features.albedo = random_rgb(rng, 1);
  s.features.normal = {s.features.albedo.r, s.features.albedo.g, s.features.albedo.b};
  if (rng() % 3 != 0) s.features.depth = 10 * s.features.albedo.r;
  if (rng() % 4 == 0) s.filter_part = FilterPart::negative;
  return s;
}

std::vector<std::vector<std::int64_t>> planes(const Film& film) {
  std::vector<std::vector<std::int64_t>> all;
  for (std::size_t i = 0; i < film.plane_count(); ++i) all.push_back(film.plane(i));
  return all;
}

struct Contribution {
  std::uint64_t pass;
  std::uint32_t pixel;
  PixelSample sample;
  std::size_t layer;
  Rgb splat;
};

std::vector<Contribution> random_contributions(std::size_t count) {
  std::mt19937 rng(7);
  std::vector<Contribution> all(count);
  for (Contribution& c : all)
    c = {rng() % 16, static_cast<std::uint32_t>(rng() % pixels), random_sample(rng), rng() % 4, random_rgb(rng, 3)};
  return all;
}

Film film_of(const std::vector<Contribution>& contributions) {
  Film film(width, height, 100, {.light = layers, .splats = true, .negative_share = 0.25f});
  for (const Contribution& c : contributions) {
    FilmPass(film, c.pass).add(c.pixel, c.sample);
    FilmPass(film, c.pass).splat(c.pixel, c.layer, c.splat);
  }
  return film;
}

TEST(Film, SumsDoNotDependOnTheOrder) {
  std::vector<Contribution> contributions = random_contributions(3000);
  const auto expected = planes(film_of(contributions));
  std::mt19937 rng(3);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(contributions.begin(), contributions.end(), rng);
    EXPECT_EQ(planes(film_of(contributions)), expected);
  }
}

TEST(Film, ConcurrentSplatsAddExactly) {
  const std::vector<Contribution> contributions = random_contributions(1000);
  Film serial(width, height, 100, {.light = layers, .splats = true}),
      parallel(width, height, 100, {.light = layers, .splats = true});
  const auto splat_all = [&](Film& film) {
    for (int i = 0; i < 300; ++i)
      for (const Contribution& c : contributions) FilmPass(film, 0).splat(c.pixel % 2, c.layer, c.splat);
  };
  for (int i = 0; i < 4; ++i) splat_all(serial);
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) threads.emplace_back([&] { splat_all(parallel); });
  }
  EXPECT_EQ(planes(serial), planes(parallel));
}

TEST(Film, MergedShardsEqualOneFilm) {
  const std::vector<Contribution> all = random_contributions(2000);
  const auto middle = all.begin() + 700;
  Film a = film_of({all.begin(), middle}), b = film_of({middle, all.end()});
  Film ba = b;
  ba.merge(a);
  a.merge(b);
  EXPECT_EQ(planes(a), planes(film_of(all)));
  EXPECT_EQ(planes(ba), planes(a));
}

// Each half equals a film of its passes only. Together they equal the picture.
TEST(Film, HalvesAreFilmsOfTheirPasses) {
  const std::vector<Contribution> all = random_contributions(3000);
  const Film film = film_of(all);
  for (const FilmHalf half : {FilmHalf::first, FilmHalf::second}) {
    std::vector<Contribution> own;
    std::copy_if(all.begin(), all.end(), std::back_inserter(own),
                 [&](const Contribution& c) { return half_of_pass(c.pass) == half; });
    EXPECT_GT(own.size(), all.size() / 5);
    const Image found = film.resolve_half(half, 5).color, expected = film_of(own).resolve_color(5);
    for (std::size_t i = 0; i < found.pixels.size(); ++i)
      EXPECT_NEAR(found.pixels[i], expected.pixels[i], 1e-6f * std::fabs(expected.pixels[i])) << i;
  }
}

// Also for quantities ordered by bit reversal, such as wavelengths: half of the passes cover each part of the range
// equally.
TEST(Film, HalvesHaveOneOfEachTwoPassesAndAreEven) {
  constexpr std::uint64_t passes = 64;
  constexpr std::uint32_t parts = 16;
  std::array<std::array<int, parts>, 2> counts{};
  for (std::uint64_t pass = 0; pass < passes; ++pass) {
    EXPECT_NE(half_of_pass(pass), half_of_pass(pass ^ 1)) << pass;
    EXPECT_EQ(number_in_half(pass), number_in_half(pass ^ 1)) << pass;
    std::uint32_t reversed = 0;
    for (int bit = 0; bit < 6; ++bit) reversed |= static_cast<std::uint32_t>(pass >> bit & 1) << (5 - bit);
    ++counts[static_cast<std::size_t>(half_of_pass(pass))][reversed * parts / passes];
  }
  for (const auto& half : counts)
    for (const int count : half) EXPECT_EQ(count, static_cast<int>(passes / parts / 2));
}

TEST(Film, BiasIsAMeanOfSamplesAndNotOfTheColor) {
  Film film(1, 1, 4, {.light = layers, .bias = true});
  for (std::uint64_t pass = 0; pass < 8; ++pass) {
    PixelSample s;
    s.light[direct] = {1, 2, 3};
    s.bias = half_of_pass(pass) == FilmHalf::first ? Rgb{-1, 0, 2} : Rgb{3, 0, 0};
    FilmPass(film, pass).add(0, s);
  }
  EXPECT_EQ(film.resolve_color(8).pixels, (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(film.resolve_half(FilmHalf::first, 4, {2, 2, 2}).bias.pixels, (std::vector<float>{-2, 0, 4}));
  EXPECT_EQ(film.resolve_half(FilmHalf::second, 4).bias.pixels, (std::vector<float>{3, 0, 0}));
  EXPECT_TRUE(Film(1, 1, 4, {.light = layers}).resolve_half(FilmHalf::first, 4).bias.pixels.empty());
}

TEST(Film, ResolvesMeans) {
  Film film(width, height, 4, {.light = layers, .splats = true});
  PixelSample s;
  s.light[emission] = {1, 2, 3};
  s.light[direct] = {0.5f, 0, 0};
  s.features.albedo = {0.25f, 0.5f, 1};
  s.features.normal = {0, 0, 1};
  s.features.depth = 3.0f;
  FilmPass(film, 0).add(8, s);
  FilmPass(film, 0).splat(8, caustic, {2, 4, 6});
  PixelSample miss;
  miss.light[emission] = {3, 3, 3};
  FilmPass(film, 1).add(8, miss);

  const Image image = film.resolve(2);
  const auto value = [&](const char* channel) { return image.at(1, 1, image.find_channel(channel).value()); };
  EXPECT_EQ(value("R"), 2 + 0.25f + 1);
  EXPECT_EQ(value("G"), 2.5f + 2);
  EXPECT_EQ(value("emission.B"), 3);
  EXPECT_EQ(value("direct.R"), 0.25f);
  EXPECT_EQ(value("caustic.B"), 3);
  EXPECT_EQ(value("albedo.G"), 0.25f);
  EXPECT_EQ(value("normal.Z"), 0.5f);
  EXPECT_EQ(value("depth.Z"), 3) << "misses have no depth";
  EXPECT_EQ(value("samples"), 2);
  EXPECT_EQ(image.at(0, 0, 0), 0);
  EXPECT_EQ(film.resolve_color(2).at(1, 1, 1), value("G"));
}

SpectralRadiance radiance_at(std::array<float, 4> lambda, float value) {
  SpectralRadiance r;
  r.lambda = lambda;
  r.radiance.fill(value);
  for (std::size_t i = 0; i < 4; ++i) r.pdf[i] = 1 / (lambda[i] + 1);  // arbitrary, but all different
  return r;
}

// With N = 1/2, a pixel is 3/2 of the mean of its samples of the filter's positive part, minus 1/2 of that of the
// others.
TEST(Film, SubtractsTheMeanOfTheNegativeLobes) {
  FilmContents contents{.light = layers, .decomposition = {.parts = {"part"}}, .splats = true, .bias = true};
  contents.buckets = SpectralBuckets{1, 400, 700};
  contents.negative_share = 0.5f;
  Film film(1, 1, 4, contents);
  const auto add = [&](std::uint64_t pass, float light, FilterPart part) {
    PixelSample s;
    s.light[direct] = s.parts[0] = s.bias = {light, 2 * light, 0};
    s.features.albedo = {light / 8, 0, 0};
    s.features.depth = light;
    s.filter_part = part;
    s.spectrum = radiance_at({410, 510, 610, 690}, light);
    FilmPass(film, pass).add(0, s);
  };
  const auto value = [&](const char* channel) {
    const Image image = film.resolve(2);
    return image.at(0, 0, image.find_channel(channel).value());
  };
  const auto expect = [&](float mean) {
    for (const char* channel : {"R", "direct.R", "part.R"}) EXPECT_EQ(value(channel), mean) << channel;
    EXPECT_NEAR(value("S0.550,0nm"), mean, 1e-5f);
    EXPECT_EQ(value("direct.G"), 2 * mean);
    EXPECT_EQ(value("albedo.R"), mean / 8);
    EXPECT_EQ(film.resolve_color(2).pixels[0], mean);
  };
  const Film empty = film;
  add(0, 1, FilterPart::negative);
  expect(1);  // samples of one part only
  film = empty;
  add(0, 4, FilterPart::positive);
  add(1, 2, FilterPart::positive);
  expect(3);
  add(3, 1, FilterPart::negative);
  expect(1.5f * 3 - 0.5f * 1);
  EXPECT_EQ(value("samples"), 3);
  EXPECT_EQ(value("depth.Z"), 7.0f / 3) << "a mean over hits of both signs";
  // Passes 0 and 3 are the first half, pass 1 is the second.
  const HalfPicture first = film.resolve_half(FilmHalf::first, 2), second = film.resolve_half(FilmHalf::second, 1);
  EXPECT_EQ(first.color.pixels[0], 1.5f * 4 - 0.5f * 1);
  EXPECT_EQ(first.bias.pixels[0], 1.5f * 4 - 0.5f * 1);
  EXPECT_EQ(second.color.pixels[0], 2);
  const Image noise = film.resolve_first_half(2);
  EXPECT_EQ(noise.at(0, 0, noise.find_channel("direct.R").value()), 1.5f * 4 - 0.5f * 1);
  // Splats are divided by the passes, whatever their sign.
  FilmPass(film, 0).splat(0, direct, {2, 0, 0});
  EXPECT_EQ(value("R"), 1.5f * 3 - 0.5f * 1 + 1);
  Film copy = Film::with_exponent(1, 1, film.step_exponent(), contents);
  for (std::size_t i = 0; i < film.plane_count(); ++i) copy.add_sums(i, 0, film.plane(i));
  EXPECT_EQ(copy.resolve(2).pixels, film.resolve(2).pixels);
}

TEST(Film, BucketsHoldMeansOverTheWavelengthsInThem) {
  const SpectralBuckets buckets{3, 400, 700};
  Film film(2, 1, 4, {.light = layers, .splats = true, .buckets = buckets});
  PixelSample s;
  s.spectrum = radiance_at({410, 480, 510, 720}, 3);  // one outside all buckets
  FilmPass(film, 0).add(0, s);
  s.spectrum = radiance_at({420, 530, 599, 399}, 3);
  FilmPass(film, 0).add(0, s);
  const auto value = [&](int x, const char* channel) {
    const Image image = film.resolve(4);
    return image.at(x, 0, image.find_channel(channel).value());
  };
  // A constant stays constant, however the wavelengths are distributed; no wavelength fell into the last bucket.
  EXPECT_NEAR(value(0, "S0.450,0nm"), 3, 1e-5f);
  EXPECT_NEAR(value(0, "S0.550,0nm"), 3, 1e-5f);
  EXPECT_EQ(value(0, "S0.650,0nm"), 0);
  EXPECT_EQ(value(1, "S0.450,0nm"), 0);
  // Varying values are averaged over wavelengths, independent of their density: pdfs here are 1 / (nm + 1).
  PixelSample varying;
  varying.spectrum = radiance_at({499, 599, 699, 900}, 0);
  varying.spectrum->lambda = {499, 419, 900, 900};
  varying.spectrum->radiance = {1, 4, 7, 7};
  FilmPass(film, 0).add(1, varying);
  EXPECT_NEAR(value(1, "S0.450,0nm"), (500 * 1 + 600 * 4) / (500.0f + 600), 1e-4f);
  film = Film(2, 1, 4, {.light = layers, .splats = true, .buckets = buckets});
  // Splats are weighted by their density and divided by the number of passes.
  FilmPass(film, 0).splat_spectrum(1, radiance_at({449, 659, 699, 900}, 2), 0.5f);
  EXPECT_NEAR(value(1, "S0.450,0nm"), 0.5f * 2 * 450 / (4 * 100) / 4, 1e-5f);
  EXPECT_NEAR(value(1, "S0.650,0nm"), 0.5f * 2 * (660 + 700) / (4 * 100) / 4, 1e-5f);
}

TEST(Film, TechniquesAddUpToColor) {
  Film film(2, 1, 4, {.light = layers, .decomposition = techniques, .splats = true});
  PixelSample s;
  s.light[direct] = {1, 2, 3};
  s.light[indirect] = {0.5f, 0.25f, 0};
  s.parts = {Rgb{0.25f, 0, 0}, Rgb{0.75f, 2, 0}, Rgb{0, 0.25f, 3}, Rgb{0.5f, 0, 0}};
  FilmPass(film, 0).add(1, s);
  FilmPass(film, 0).splat(1, caustic, {2, 0, 0});
  FilmPass(film, 0).splat(1, direct, {0, 0, 4});
  const auto layer = [&](const char* name) { return select_layer(film.resolve(2), name).value(); };
  std::vector<float> sum(6);
  for (const char* name : {"hit", "nee", "vc", "vm", "splat"}) {
    const Image part = layer((std::string("technique.") + name).c_str());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part.pixels[i];
  }
  EXPECT_EQ(sum, layer("color").pixels);
  EXPECT_EQ(layer("technique.nee").pixels, (std::vector<float>{0, 0, 0, 0.75f, 2, 0}));
  EXPECT_EQ(layer("technique.splat").pixels, (std::vector<float>{0, 0, 0, 1, 0, 2}));
  const Image share = layer("technique.share");
  const double all = static_cast<double>(luminance({2.5f, 2.25f, 5}));
  EXPECT_NEAR(share.at(1, 0, 0), 0.5 * 0.2126 / all, 1e-6);
  EXPECT_NEAR(share.at(1, 0, 2), 0.25 * 0.2126 / all, 1e-6);
  EXPECT_NEAR(share.at(1, 0, 0) + share.at(1, 0, 1) + share.at(1, 0, 2), 1, 1e-6);

  Film copy = Film::with_exponent(2, 1, film.step_exponent(), film.contents());
  for (std::size_t i = 0; i < film.plane_count(); ++i) copy.add_sums(i, 0, film.plane(i));
  EXPECT_EQ(copy.resolve(2).pixels, film.resolve(2).pixels);
  copy.merge(film);
  EXPECT_EQ(select_layer(copy.resolve(4), "technique.share")->pixels, share.pixels);
  EXPECT_EQ(select_layer(copy.resolve(4), "technique.splat")->pixels, layer("technique.splat").pixels);
}

// Light of wavelengths outside the gamut may have negative luminance. It counts as a share of 0.
TEST(Film, SharesAreOfPositiveLight) {
  Film film(1, 1, 4, {.light = layers, .decomposition = techniques});
  PixelSample s;
  s.parts = {Rgb{1, 1, 1}, Rgb{0, -1, 0}, Rgb{0, 0, 0}, Rgb{1, 1, 1}};
  FilmPass(film, 0).add(0, s);
  EXPECT_EQ(select_layer(film.resolve(1), "technique.share")->pixels, (std::vector<float>{0.5f, 0, 0.5f}));
}

TEST(Film, BucketsAreSavedAndMergedExactly) {
  const SpectralBuckets buckets{5, 360, 830};
  const auto film_of_passes = [&](unsigned begin, unsigned end) {
    Film film(2, 2, 4, {.light = layers, .splats = true, .buckets = buckets});
    for (unsigned pass = begin; pass < end; ++pass) {
      std::mt19937 rng(pass);
      const auto nm = [&] { return 350 + 490 * std::generate_canonical<float, 24>(rng); };
      for (std::uint32_t pixel = 0; pixel < 4; ++pixel) {
        PixelSample s;
        s.spectrum = radiance_at({nm(), nm(), nm(), nm()}, nm());
        FilmPass(film, pass).add(pixel, s);
        FilmPass(film, pass).splat_spectrum(pixel, radiance_at({nm(), nm(), nm(), nm()}, 1e-9f), 1);
      }
    }
    return film;
  };
  const Film whole = film_of_passes(0, 9);
  Film merged = film_of_passes(5, 9);
  ASSERT_TRUE(merged.compatible(whole));
  EXPECT_FALSE(merged.compatible(Film(2, 2, 4, {.light = layers, .splats = true})));
  merged.merge(film_of_passes(0, 5));
  ASSERT_EQ(whole.plane_count(), 2 * (first_splats + 12) + 3 * 5);
  Film copy = Film::with_exponent(2, 2, whole.step_exponent(), {.light = layers, .splats = true, .buckets = buckets});
  for (std::size_t i = 0; i < whole.plane_count(); ++i) {
    EXPECT_EQ(merged.plane(i), whole.plane(i)) << i;
    copy.add_sums(i, 0, whole.plane(i));
  }
  EXPECT_EQ(copy.resolve(9).pixels, whole.resolve(9).pixels);
  EXPECT_NE(whole.plane(whole.plane_count() - 1), std::vector<std::int64_t>(4));
}

TEST(Film, SamplesThatAreScaledDownAreSoInTheirBuckets) {
  Film film(1, 1, 4, {.buckets = SpectralBuckets{1, 400, 700}});
  film.set_sensor({{}, 0.5f});
  PixelSample s;
  s.light[emission] = {1, 1, 1};  // Y = 1, Z = 1.089
  s.spectrum = radiance_at({450, 500, 550, 600}, 1);
  FilmPass(film, 0).add(0, s);
  const Image image = film.resolve(1);
  EXPECT_NEAR(image.at(0, 0, image.channel_count() - 1), image.at(0, 0, 0), 1e-5f);
  EXPECT_LT(image.at(0, 0, 0), 0.5f);
}

TEST(Film, LightLayersAddUpToColor) {
  const Image image = film_of(random_contributions(3000)).resolve(16);
  const Image color = select_layer(image, "color").value();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0, magnitude = 0;
        for (const std::size_t layer : {emission, direct, indirect, caustic}) {
          const double part = select_layer(image, layers[layer]).value().at(x, y, c);
          sum += part;
          magnitude += std::fabs(part);
        }
        EXPECT_NEAR(color.at(x, y, c), sum, 1e-6 * magnitude);
      }
}

TEST(Film, TinyContributionsAreNotLost) {
  // 2^-45 of the largest radiance is 1/32 of a step: rounding to nearest would lose all of it.
  Film film(1, 1, 1, {.light = layers, .splats = true});
  std::mt19937 rng(5);
  double expected = 0;
  constexpr int count = 200000;
  for (int i = 0; i < count; ++i) {
    const float value = std::generate_canonical<float, 24>(rng) * 0x1p-44f;
    expected += static_cast<double>(value);
    FilmPass(film, static_cast<std::uint64_t>(i)).splat(0, indirect, {value, 0x1p-45f, -value});
    PixelSample s;
    s.light[caustic].r = value;
    FilmPass(film, static_cast<std::uint64_t>(i)).add(0, s);
  }
  const auto sum = [&](std::size_t slot) {
    return static_cast<double>(film.plane(slot)[0] + film.plane(film.plane_count() / 2 + slot)[0]) * 0x1p-40;
  };
  // The sum of count rounding errors has a standard deviation of at most sqrt(count) / 2 steps. |z| > 5: 6e-7.
  const double tolerance = 5 * 0.5 * std::sqrt(count) * 0x1p-40;
  EXPECT_NEAR(sum(9), expected, tolerance);
  EXPECT_NEAR(sum(first_splats + 6), expected, tolerance);
  EXPECT_NEAR(sum(first_splats + 7), count * 0x1p-45, tolerance) << "equal values must be rounded differently";
  EXPECT_NEAR(sum(first_splats + 8), -expected, tolerance);
}

TEST(Film, FloatsInRangeAreStoredExactly) {
  Film film(1, 1, 3, {.light = layers});
  EXPECT_EQ(film.step_exponent(), 2 - 40);
  PixelSample s;
  s.light[direct] = {0x1.fffffep-15f, -0x1.234566p0f, 2.9999998f};
  FilmPass(film, 0).add(0, s);
  const Image image = film.resolve(1);
  EXPECT_EQ(select_layer(image, "direct")->pixels, (std::vector<float>{0x1.fffffep-15f, -0x1.234566p0f, 2.9999998f}));
}

TEST(Film, ReportsNonFiniteValuesWithTheirPlace) {
  Film film(width, height, 1, {.light = layers, .splats = true});
  PixelSample bad;
  bad.light[indirect] = {std::nanf(""), 1, infinity};
  FilmPass(film, 9).add(3, bad);
  FilmPass(film, 4).add(20, bad);
  FilmPass(film, 4).splat(11, caustic, {0, -infinity, 0});
  const FilmReport report = film.report();
  EXPECT_FALSE(report.clean());
  EXPECT_EQ(report.non_finite, 5u);
  EXPECT_EQ(report.first_non_finite, (FilmPlace{4, 11}));
  EXPECT_EQ(film.resolve(1).at(3, 0, 1), 1) << "the finite parts count";
}

TEST(Film, ReportsOverflowAndSaturates) {
  Film film(2, 1, 1, {.light = layers, .decomposition = techniques, .splats = true});
  FilmPass(film, 3).splat(1, direct, {0x1p16f, 0x1p17f, 0});  // at the limit of a contribution, and above it
  EXPECT_EQ(film.report().too_large, 1u);
  EXPECT_EQ(film.report().first_too_large, (FilmPlace{3, 1}));
  EXPECT_EQ(film.report().saturated, 0u);
  PixelSample s;
  s.light[emission] = {-0x1p16f, 0x1p15f, 0};
  s.parts[0].g = 0x1p16f;
  for (int i = 0; i < 100; ++i) {
    FilmPass(film, 3).splat(1, direct, {0x1p16f, 0, 0});
    FilmPass(film, 3).add(0, s);
  }
  EXPECT_EQ(film.report().saturated, 3u);
  EXPECT_EQ(film.plane(first_splats + 3)[1], std::int64_t{1} << 62);
  EXPECT_EQ(film.plane(0)[0], -(std::int64_t{1} << 62));
  FilmPass(film, 3).splat(1, direct, {-1, 0, 0});
  s.light[emission].r = 1;
  FilmPass(film, 3).add(0, s);
  EXPECT_EQ(film.plane(0)[0], -(std::int64_t{1} << 62)) << "saturation sticks";
  EXPECT_EQ(film.plane(first_splats + 3)[1], std::int64_t{1} << 62) << "saturation sticks";
  Film other = film;
  film.merge(other);
  EXPECT_EQ(film.report().saturated, 4u) << "twice 100 * 2^15 is too much as well";
}

TEST(Film, ConcurrentOverflowSaturates) {
  Film film(1, 1, 1, {.light = layers, .splats = true});
  parallel_for(0, 2000, [&](int) { FilmPass(film, 0).splat(0, direct, {0x1.9p15f, -0x1.7p15f, 1}); });
  EXPECT_EQ(film.plane(first_splats + 3)[0], std::int64_t{1} << 62);
  EXPECT_EQ(film.report().saturated, 2u);
}

// Passes 0, 3, 5 and 6 belong to one half.
TEST(Film, AddsSamplesOfSeveralPassesToOnePixelAtOnce) {
  FilmContents contents{.light = {"direct"}, .decomposition = {.parts = {"a", "b"}}, .bias = true};
  contents.buckets = SpectralBuckets{};
  constexpr int samples = 2000000;  // so that threads collide
  const std::array<std::uint64_t, 4> passes{0, 3, 5, 6};
  const auto add = [](Film& film, std::uint64_t pass, int i) {
    PixelSample s;
    s.light[0] = {static_cast<float>(i), 1e-13f, 1};
    s.parts[1] = s.light[0];
    s.spectrum = radiance_at({449, 559, 659, 699}, 2);
    FilmPass(film, pass).add(0, s);
  };
  Film together(1, 1, 1, contents), in_turn(1, 1, 1, contents);
  parallel_for(0, samples, [&](int i) { add(together, passes[static_cast<std::size_t>(i) % 4], i); });
  for (int i = 0; i < samples; ++i) add(in_turn, passes[static_cast<std::size_t>(i) % 4], i);
  for (std::size_t plane = 0; plane < together.plane_count(); ++plane)
    EXPECT_EQ(together.plane(plane), in_turn.plane(plane)) << plane;
}

TEST(Film, ConcurrentReportsAgreeOnTheFirstPlace) {
  Film film(100, 100, 1, {.light = layers, .splats = true});
  parallel_for(0u, 10000u, [&](std::uint32_t i) {
    if (i >= 17) FilmPass(film, 1).splat(i, direct, {infinity, 0, 0});
  });
  EXPECT_EQ(film.report().non_finite, 10000u - 17);
  EXPECT_EQ(film.report().first_non_finite, (FilmPlace{1, 17}));
}

TEST(Display, TransferFunctionsAreInverse) {
  for (float x = 0; x <= 1; x += 0.001f) EXPECT_NEAR(linear_from_srgb(srgb_from_linear(x)), x, 2e-6f);
  EXPECT_NEAR(srgb_from_linear(0.5f), 0.735357f, 1e-5f);
}

TEST(Display, MapsToTheUnitInterval) {
  const Rgb clamped = to_display({-1, 2, std::nanf("")}, {});
  EXPECT_EQ(clamped.r, 0);
  EXPECT_FLOAT_EQ(clamped.g, 1);
  EXPECT_EQ(clamped.b, 0);
  EXPECT_NEAR(to_display({0.25f, 0, 0}, {.exposure = 1}).r, srgb_from_linear(0.5f), 1e-6f);
  const DisplaySettings filmic{.curve = ToneCurve::filmic};
  EXPECT_NEAR(to_display({0.18f, 0, 0}, filmic).r, srgb_from_linear(0.2667f), 1e-3f);
  EXPECT_FLOAT_EQ(to_display({infinity, 0, 0}, filmic).r, 1);
  EXPECT_FLOAT_EQ(to_display({1e30f, 0, 0}, filmic).r, 1);
}

// Properties of the curve by construction: middle grey is in the middle, black 10 stops below it, white 6.5 above it,
// and the slope is 2 in the middle, over all 16.5 stops.
TEST(Display, AgxKeepsGreysAndTakesSaturationFromBrightColours) {
  const auto grey = [](float x) { return agx({x, x, x}); };
  EXPECT_NEAR(grey(0.18f).r, 0.5f, 1e-5f);
  EXPECT_NEAR(grey(0.18f * std::exp2(-10.0f)).r, 0, 1e-4f);
  EXPECT_NEAR(grey(0.18f * std::exp2(6.5f)).r, 1, 1e-4f);
  EXPECT_NEAR(grey(0).g, 0, 1e-6f);
  EXPECT_NEAR(grey(1e4f).b, 1, 1e-5f);
  const float step = 0.01f;
  EXPECT_NEAR((grey(0.18f * std::exp2(step)).r - grey(0.18f * std::exp2(-step)).r) / (2 * step), 2 / 16.5f, 1e-3f);
  float before = -1;
  for (float stops = -10; stops <= 6.5f; stops += 0.25f) {
    const Rgb c = grey(0.18f * std::exp2(stops));
    EXPECT_NEAR(c.r, c.g, 1e-5f);
    EXPECT_NEAR(c.r, c.b, 1e-5f);
    EXPECT_GT(c.r, before);
    before = c.r;
  }
  // From dim to bright, red becomes white without changing its hue.
  const Rgb dim = agx({0.1f, 0, 0}), bright = agx({100, 0, 0});
  EXPECT_GT(dim.r, 2 * dim.g);
  EXPECT_GT(bright.g, 0.6f * bright.r);
  EXPECT_NEAR(bright.g, bright.b, 0.02f);
  // The inset of the primaries leaves neutral colours (equal red, green and blue) unchanged.
  const DisplaySettings display{.exposure = 1, .curve = ToneCurve::agx};
  EXPECT_NEAR(to_display({0.09f, 0.09f, 0.09f}, display).r, 0.5f, 1e-5f);
  EXPECT_FLOAT_EQ(to_display({infinity, infinity, infinity}, display).r, 1);
  EXPECT_NEAR(to_display({-1, std::nanf(""), 0}, display).r, 0, 1e-6f);
}

// Properties of the curve by construction, for whites up to sixteen stops above white.
TEST(Display, HighlightsAreCompressedUpToTheBrightest) {
  for (const float white : {1.001f, 1.5f, 4.0f, 160.0f, 60000.0f}) {
    const HighlightCurve curve(white);
    for (const float x : {0.0f, 0.1f, 0.7f}) EXPECT_EQ(curve(x), x);
    EXPECT_NEAR(curve(white), 1, 1e-4f) << white;
    const float step = 1e-3f;
    EXPECT_NEAR((curve(0.7f + step) - 0.7f) / step, 1, 0.05f) << "no kink at the knee";
    for (float x = 0.7f; 1.1f * x < white; x *= 1.1f) EXPECT_GT(curve(1.1f * x), curve(x));
    EXPECT_LE(curve(1), 1);
    EXPECT_GT(curve(1), 0.75f) << "white surfaces stay nearly white beside any lamp";
  }
  for (const float white : {0.0f, 0.5f, 1.0f}) EXPECT_EQ(HighlightCurve(white)(3), 3);
}

TEST(Display, HighlightsKeepPicturesWithoutAny) {
  Image image(100, 20, {"R", "G", "B"});  // from black to white
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<float>(i) / static_cast<float>(image.pixels.size() - 1);
  EXPECT_EQ(displayed(image, {.curve = ToneCurve::highlights}).pixels, displayed(image).pixels);
  EXPECT_NEAR(brightest_level(image), 0.999f, 1e-3f);
  // A lamp in 1 % of the picture, with a gradient from 50 to 100, and a firefly.
  constexpr std::size_t lamp = 20;
  for (std::size_t p = 0; p < lamp; ++p)
    for (std::size_t c = 0; c < 3; ++c) image.pixels[3 * p + c] = 50 + 2.5f * static_cast<float>(p + 1);
  image.pixels.back() = 1e6f;
  EXPECT_NEAR(brightest_level(image), 100, 3);
  const Image kept = displayed(image, {.curve = ToneCurve::highlights}), burnt = displayed(image);
  EXPECT_EQ(burnt.pixels[0], burnt.pixels[3 * lamp - 1]);
  EXPECT_LT(kept.pixels[0], kept.pixels[3 * lamp - 1] - 0.01f);
  EXPECT_EQ(kept.pixels[3000], burnt.pixels[3000]) << "half as bright as white";
  // With two stops of exposure, and with the brightest level of another picture.
  EXPECT_GT(displayed(image, {.exposure = 2, .curve = ToneCurve::highlights}).pixels[3000], kept.pixels[3000]);
  EXPECT_LT(displayed(image, {.curve = ToneCurve::highlights, .brightest = 1e4f}).pixels[0], kept.pixels[0]);
}

// A picture of 100 x 1 pixels: surfaces of equal albedo in equal light, a lamp in a fifth of the picture, the rest
// black.
Image lit_picture(float albedo, float light, int surfaces) {
  std::vector<std::string> channels{"R", "G", "B"};
  for (const char* layer : {"emission", "direct", "indirect", "caustic", "albedo"})
    for (const char* component : {".R", ".G", ".B"}) channels.push_back(std::string(layer) + component);
  Image image(100, 1, channels);
  for (int x = 0; x < 20 + surfaces; ++x)
    for (std::size_t c = 0; c < 3; ++c) {
      const bool is_lamp = x < 20;
      image.at(x, 0, 3 + c) = is_lamp ? 1000.0f : 0.0f;
      image.at(x, 0, 6 + c) = is_lamp ? 0.0f : 0.75f * albedo * light;
      image.at(x, 0, 9 + c) = is_lamp ? 0.0f : 0.25f * albedo * light;
      image.at(x, 0, 15 + c) = is_lamp ? 0.0f : albedo;
      image.at(x, 0, c) = is_lamp ? 1000.0f : albedo * light;
    }
  return image;
}

TEST(Exposure, IsThatOfTheLightOnSurfacesWhateverTheirColour) {
  for (const float albedo : {1.0f, 0.5f, 0.05f}) {
    EXPECT_FLOAT_EQ(measured_exposure(lit_picture(albedo, 0.125f, 60)), 3);
    EXPECT_FLOAT_EQ(measured_exposure(lit_picture(albedo, 1024, 60)), -10);
  }
}

TEST(Exposure, IsThatOfColoursWhereNoSurfaceIsLit) {
  EXPECT_FLOAT_EQ(measured_exposure(lit_picture(1, 1, 0)), -10);  // 1000, within a tenth of a stop
  EXPECT_FLOAT_EQ(measured_exposure(lit_picture(0.001f, 1, 60)), -10);
  Image plain(10, 1, {"R", "G", "B"});
  EXPECT_EQ(measured_exposure(plain), 0);
  for (float& x : plain.pixels) x = 0.25f;
  EXPECT_FLOAT_EQ(measured_exposure(plain), 2);
  plain.pixels.back() = infinity;
  plain.pixels.front() = std::nanf("");
  EXPECT_FLOAT_EQ(measured_exposure(plain), 2);
  for (float& x : plain.pixels) x = 1e-30f;
  EXPECT_EQ(measured_exposure(plain), 64);
}

Image test_image() {
  Image image(5, 3, {"R", "G", "B", "direct.R", "direct.G", "direct.B", "depth.Z", "samples"});
  std::iota(image.pixels.begin(), image.pixels.end(), -3.5f);
  image.window = {2, 1, 16, 9};
  return image;
}

// Fichet, Pacanowski & Wilkie 2021, "An OpenEXR Layout for Spectral Images": names of channels, and two attributes.
TEST(ImageFile, SpectralChannelsFollowTheirLayout) {
  const test::TemporaryDir dir;
  const Film film(2, 1, 1, {.buckets = SpectralBuckets{16, 360, 830}});
  const Image image = film.resolve(1);
  EXPECT_TRUE(image.find_channel("S0.374,6875nm"));
  EXPECT_TRUE(image.find_channel("S0.815,3125nm"));
  EXPECT_EQ(std::count_if(image.channels.begin(), image.channels.end(), is_spectral_channel), 16);
  write_exr(dir.path() / "a.exr", image);
  const auto file = OIIO::ImageInput::open((dir.path() / "a.exr").string());
  ASSERT_TRUE(file);
  EXPECT_EQ(file->spec().get_string_attribute("spectralLayoutVersion"), "1.0");
  EXPECT_EQ(file->spec().get_string_attribute("emissiveUnits"), "W.m^-2.sr^-1");
  const Image read = read_image(dir.path() / "a.exr");
  EXPECT_TRUE(select_layer(read, "S0.374,6875nm"));
  EXPECT_EQ(layer_names(read).size(), layer_names(image).size());
  write_exr(dir.path() / "b.exr", test_image());
  EXPECT_EQ(OIIO::ImageInput::open((dir.path() / "b.exr").string())->spec().get_string_attribute("emissiveUnits"), "");
}

TEST(ImageFile, ExrKeepsLayersWindowAndMetadata) {
  const test::TemporaryDir dir;
  const Image image = test_image();
  const nlohmann::json metadata{{"seed", 18446744073709551615ull},
                                {"passes", 12},
                                {"scene", "a b.pbrt"},
                                {"seconds", 1.5},
                                {"parameters", {{"radius", 0.5}}}};
  write_exr(dir.path() / "a.exr", image, metadata.dump());
  const Image read = read_image(dir.path() / "a.exr");
  EXPECT_EQ(read.window, image.window);
  for (const char* layer : {"color", "direct", "depth", "samples"}) {
    ASSERT_TRUE(select_layer(read, layer)) << layer;
    EXPECT_EQ(select_layer(read, layer)->pixels, select_layer(image, layer)->pixels) << layer;
  }
  EXPECT_FALSE(select_layer(read, "albedo"));
  const nlohmann::json found = nlohmann::json::parse(read_image_metadata(dir.path() / "a.exr"));
  EXPECT_EQ(found["seed"], "18446744073709551615");
  EXPECT_EQ(found["passes"], 12);
  EXPECT_EQ(found["scene"], "a b.pbrt");
  EXPECT_EQ(found["seconds"], 1.5);
  EXPECT_EQ(found["parameters"], R"({"radius":0.5})");
}

TEST(ImageFile, EqualImagesGiveEqualBytes) {
  const test::TemporaryDir dir;
  for (const char* extension : {".exr", ".png"}) {
    const auto a = (dir.path() / "a").replace_extension(extension);
    const auto b = (dir.path() / "b").replace_extension(extension);
    write_image(a, test_image(), {}, R"({"seed": 1})");
    write_image(b, test_image(), {}, R"({"seed": 1})");
    EXPECT_EQ(read_file(a), read_file(b));
  }
}

TEST(ImageFile, PngRoundTripsWithinItsPrecision) {
  const test::TemporaryDir dir;
  Image image(16, 16, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i) / 600;
  write_png(dir.path() / "a.png", image);
  const Image read = read_image(dir.path() / "a.png");
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    EXPECT_NEAR(srgb_from_linear(read.pixels[i]), std::min(1.0f, srgb_from_linear(image.pixels[i])), 0.501f / 255);
  const Image raw = read_image(dir.path() / "a.png", ColorEncoding::linear);
  EXPECT_NEAR(raw.pixels[300], srgb_from_linear(0.5f), 0.501f / 255);
}

TEST(ImageFile, AlphaIsNotDecoded) {
  const test::TemporaryDir dir;
  const std::string file = dir.path() / "a.png";
  const std::array<std::uint8_t, 4> pixel{128, 128, 128, 128};
  const auto output = OIIO::ImageOutput::create(file);
  OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeUInt8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  ASSERT_TRUE(output->open(file, spec) && output->write_image(OIIO::TypeUInt8, pixel.data()) && output->close());
  const Image image = read_image(file);
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_NEAR(image.pixels[3], 128.0f / 255, 1e-6f);
  EXPECT_NEAR(image.pixels[0], linear_from_srgb(128.0f / 255), 1e-6f) << "colour is as stored: not multiplied by alpha";
}

TEST(ImageFile, ReadsPfmTopToBottom) {
  const test::TemporaryDir dir;
  const std::array<float, 6> values{1, 2, 3, 4, 5, 6};  // PFM stores the lower row first
  std::string bytes = "PF\n1 2\n-1.0\n";
  bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(values));
  const Image image = read_image(dir.write("a.pfm", bytes));
  EXPECT_EQ(image.pixels, (std::vector<float>{4, 5, 6, 1, 2, 3}));
}

TEST(ImageFile, UnreadableFilesAreErrors) {
  const test::TemporaryDir dir;
  EXPECT_THROW(read_image(dir.path() / "none.exr"), Error);
  EXPECT_THROW(read_image(dir.path()), Error);
  EXPECT_THROW(read_image(dir.write("text.exr", "not an image")), Error);
  EXPECT_THROW(read_image(dir.write("text.pbrt", "WorldBegin")), Error);
  EXPECT_THROW(write_image(dir.path() / "a.gif", test_image(), {}, {}), Error);
}

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(WriteFile, ReplacesWholeFilesAndFollowsLinks) {
  const test::TemporaryDir dir;
  const auto file = dir.write("old.png", "old");
  const auto link = dir.path() / "link.png";
  std::filesystem::create_symlink(file, link);
  write_png(link, test_image());
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(read_image(file).width, 5);
  EXPECT_EQ(files_in(dir.path()), 2u);
}

TEST(WriteFile, UnwritablePlacesAreErrors) {
  const test::TemporaryDir dir;
  EXPECT_THROW(write_exr("/proc/a.exr", test_image()), Error);
  EXPECT_THROW(write_exr(dir.path(), test_image()), Error);
  EXPECT_THROW(write_exr(dir.path() / "none" / "a.exr", test_image()), Error);
  EXPECT_EQ(files_in(dir.path()), 0u);
  EXPECT_EQ(test::error_text([] { write_exr("/dev/full", test_image()); }),
            "/dev/full: cannot write: No space left on device; free some space or choose another folder");
}

TEST(WriteFile, AFailedWriteKeepsTheOldFileAndLeavesNothing) {
  const test::TemporaryDir dir;
  const auto file = dir.write("a.bin", "old");
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small{4096, limit.rlim_max};
  const auto old_handler = signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(write_file(file, std::vector<std::byte>(10000)), Error);
  setrlimit(RLIMIT_FSIZE, &limit);
  signal(SIGXFSZ, old_handler);
  EXPECT_EQ(read_file(file).size(), 3u);
  EXPECT_EQ(files_in(dir.path()), 1u);
}

TEST(FileSet, WritesAllFilesOrNone) {
  const test::TemporaryDir dir;
  const auto old = dir.write("a.bin", "old");
  const std::vector<std::byte> bytes(100);
  {
    FileSet files;
    files.add(old, bytes);
    files.add(dir.path() / "b.bin", bytes);
    EXPECT_THROW(files.add(dir.path(), bytes), Error);
  }
  EXPECT_EQ(read_file(old), "old");
  EXPECT_EQ(files_in(dir.path()), 1u);
  FileSet files;
  files.add(old, bytes);
  files.add(dir.path() / "b.bin", bytes);
  EXPECT_EQ(read_file(old), "old");
  files.commit();
  EXPECT_EQ(read_file(old).size(), 100u);
  EXPECT_EQ(read_file(dir.path() / "b.bin").size(), 100u);
  EXPECT_EQ(files_in(dir.path()), 2u);
}

// A grey of 4 has XYZ (3.80, 4, 4.36): all layers are scaled by 2 / 4.36, except the albedo, which is not light.
TEST(Film, SamplesAreClampedAsAWhole) {
  Film film(1, 1, 10, {.light = layers, .decomposition = techniques, .splats = true});
  film.set_sensor({{}, 2.0f});
  PixelSample bright;
  bright.light[direct] = {1, 1, 1};
  bright.light[caustic] = {3, 3, 3};
  bright.parts[2] = {4, 4, 4};
  bright.features.albedo = {1, 1, 1};
  FilmPass(film, 0).add(0, bright);
  const Image image = film.resolve(1);
  const auto mean = [&](const char* channel) { return image.at(0, 0, *image.find_channel(channel)); };
  EXPECT_NEAR(mean("R"), 4 * 2 / 4.356f, 0.003f);
  EXPECT_NEAR(mean("caustic.G"), 3 * mean("direct.G"), 1e-6f);
  EXPECT_NEAR(mean("technique.vc.B"), mean("B"), 1e-6f);
  EXPECT_EQ(mean("albedo.B"), 1);
  Film dim(1, 1, 10, {.light = layers});
  dim.set_sensor({{}, 4.4f});
  FilmPass(dim, 0).add(0, bright);
  EXPECT_EQ(dim.resolve(1).at(0, 0, 0), 4);
}

TEST(Film, SensorsBalanceSamplesAndSplats) {
  const RgbMatrix balance{{{{0, 1, 0}, {2, 0, 0}, {0, 0, 0.5f}}}};
  Film film(1, 1, 10, {.light = layers, .decomposition = techniques, .splats = true});
  film.set_sensor({balance, {}});
  PixelSample sample;
  sample.light[emission] = {1, 2, 3};
  sample.parts[0] = sample.light[emission];
  FilmPass(film, 0).add(0, sample);
  FilmPass(film, 0).splat(0, caustic, {4, 5, 6});
  const Image image = film.resolve(1);
  EXPECT_EQ(select_layer(image, "technique.hit")->pixels, select_layer(image, "emission")->pixels);
  EXPECT_EQ(image.at(0, 0, 0), 2 + 5);
  EXPECT_EQ(image.at(0, 0, 1), 2 + 8);
  EXPECT_EQ(image.at(0, 0, 2), 1.5f + 3);
}

}  // namespace
}  // namespace lanthorn::film_test
