// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/denoise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/threads.h"

namespace lanthorn::denoise_test {
namespace {

using Field = std::function<double(int x, int y)>;
double none(int /*x*/, int /*y*/) { return 0; }

// A layer of grey light: its true value, and the standard deviation of each half's noise. Pixels within `radius` share
// noise.
struct Layer {
  std::string name;
  Field truth, sigma = none;
  int radius = 0;
};

// Normal numbers of variance 1: independent, or smoothed over squares.
std::vector<double> noise_field(int width, int height, int radius, std::mt19937& rng) {
  std::normal_distribution<double> normal;
  const int w = width + 2 * radius, side = 2 * radius + 1;
  std::vector<double> raw(static_cast<std::size_t>(w * (height + 2 * radius))), field;
  for (double& x : raw) x = normal(rng);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) sum += raw[static_cast<std::size_t>((y + j) * w + x + i)];
      field.push_back(sum / side);
    }
  return field;
}

// A picture of two halves, as made by `with_noise`. The surface is white except for its albedo.
struct Scene {
  int width, height;
  std::vector<Layer> layers;
  Field albedo = [](int, int) { return 0.5; };
};

Image picture_of(const Scene& scene, unsigned seed = 1) {
  std::mt19937 rng(seed);
  std::vector<std::string> channels{"R", "G", "B"};
  for (const Layer& layer : scene.layers)
    for (const char* c : {".R", ".G", ".B"}) channels.push_back(layer.name + c);
  for (const char* c : {"albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "position.X",
                        "position.Y", "position.Z"})
    channels.emplace_back(c);
  const std::size_t with_noise = channels.size();
  for (std::size_t c = 3; c < with_noise; ++c) channels.push_back("noise." + channels[c]);
  channels.emplace_back("samples");
  channels.emplace_back("noise.share");
  Image image(scene.width, scene.height, channels);
  const auto channel = [&](const std::string& name) { return *image.find_channel(name); };
  const auto for_each_pixel = [&](auto&& body) {
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) body(x, y);
  };
  for (const Layer& layer : scene.layers)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::vector<double> a = noise_field(image.width, image.height, layer.radius, rng),
                                b = noise_field(image.width, image.height, layer.radius, rng);
      const std::size_t first = channel(layer.name + ".R") + c, noise = channel("noise." + layer.name + ".R") + c;
      std::size_t i = 0;
      for_each_pixel([&](int x, int y) {
        const double s = layer.sigma(x, y);
        image.at(x, y, first) = static_cast<float>(layer.truth(x, y) + s * (a[i] + b[i]) / 2);
        image.at(x, y, noise) = static_cast<float>(s * (a[i] - b[i]) / 2);
        if (layer.name != "media") image.at(x, y, c) += image.at(x, y, first);
        ++i;
      });
    }
  for_each_pixel([&](int x, int y) {
    for (std::size_t c = 0; c < 3; ++c)
      image.at(x, y, channel("albedo.R") + c) = static_cast<float>(scene.albedo(x, y));
    image.at(x, y, channel("normal.Z")) = 1;
    image.at(x, y, channel("position.X")) = static_cast<float>(x);
    image.at(x, y, channel("position.Y")) = static_cast<float>(y);
    image.at(x, y, channel("samples")) = 16;
    image.at(x, y, channel("noise.share")) = 0.5f;
  });
  return image;
}

double mean_square(const Image& image, const std::string& layer, const Field& truth) {
  const std::size_t first = *image.find_channel(layer + "R");
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const double d = static_cast<double>(image.at(x, y, first + c)) - truth(x, y);
        sum += d * d;
      }
  return sum / (3.0 * image.width * image.height);
}

double gain(const Scene& scene, const std::string& layer, const Field& truth, unsigned seed = 1) {
  const Image noisy = picture_of(scene, seed);
  return mean_square(noisy, layer + ".", truth) / mean_square(denoise(noisy).picture, "denoised." + layer + ".", truth);
}

double smooth(int x, int y) { return 1 + 0.5 * std::sin(0.05 * x) + 0.01 * y; }
double fifth(int /*x*/, int /*y*/) { return 0.2; }
double step(int x, int /*y*/) { return x < 32 ? 0.3 : 2; }

TEST(Denoise, RemovesNoiseOfSmoothLight) {
  EXPECT_GT(gain({96, 80, {{"direct", smooth, fifth}}}, "direct", smooth), 25);
}

TEST(Denoise, KeepsLayersWithoutNoiseToTheBit) {
  const Image noisy = picture_of({40, 30, {{"emission", step}, {"direct", smooth, fifth}}});
  const Image out = denoise(noisy).picture;
  const std::size_t before = *noisy.find_channel("emission.R"), after = *out.find_channel("denoised.emission.R");
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(out.at(x, y, after + c), noisy.at(x, y, before + c));
}

TEST(Denoise, LayersAddUpToThePicture) {
  const Image noisy =
      picture_of({64, 48, {{"emission", step, fifth}, {"direct", smooth, fifth}, {"media", smooth, fifth}}});
  const Image out = denoise(noisy).picture;
  const auto at = [&](int x, int y, const char* layer, std::size_t c) {
    return out.at(x, y, *out.find_channel(layer) + c);
  };
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_EQ(at(x, y, "denoised.R", c), at(x, y, "denoised.emission.R", c) + at(x, y, "denoised.direct.R", c));
        ASSERT_EQ(at(x, y, "R", c), noisy.at(x, y, c));
      }
  EXPECT_LT(mean_square(out, "denoised.media.", smooth), mean_square(out, "media.", smooth) / 10);
}

// No feature shows the edge of a caustic: its two sides may mix by at most a pixel.
TEST(Denoise, KeepsTheEdgesOfCaustics) {
  const Scene scene{64, 64, {{"caustic", step, fifth}, {"direct", smooth, fifth}}};
  const Image out = denoise(picture_of(scene)).picture;
  const std::size_t red = *out.find_channel("denoised.caustic.R");
  std::array<double, 64> profile{};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) profile[static_cast<std::size_t>(x)] += static_cast<double>(out.at(x, y, red)) / 64;
  for (const std::size_t x : {20, 28, 30}) EXPECT_NEAR(profile[x], 0.3, 0.06) << x;
  for (const std::size_t x : {33, 35, 43}) EXPECT_NEAR(profile[x], 2, 0.06) << x;
  EXPECT_GT(gain(scene, "caustic", step), 8);
}

// Texture is kept: it is not smoothed together with the noise.
TEST(Denoise, KeepsTexture) {
  const auto albedo = [](int x, int y) { return (x / 3 + y / 3) % 2 == 0 ? 0.9 : 0.2; };
  const auto light = [&](int x, int y) { return albedo(x, y) * smooth(x, y); };
  EXPECT_GT(gain({72, 72, {{"indirect", light, fifth}}, albedo}, "indirect", light), 10);
}

// Photons within a kernel cause noise that pixels share.
TEST(Denoise, RemovesNoiseThatNeighboursShare) {
  EXPECT_GT(gain({128, 128, {{"caustic", smooth, fifth, 3}}}, "caustic", smooth), 4);
}

TEST(Denoise, RemovesASpikeOfOneHalf) {
  Image noisy = picture_of({64, 64, {{"indirect", smooth, fifth}}});
  const std::size_t red = *noisy.find_channel("indirect.R"), noise = *noisy.find_channel("noise.indirect.R");
  const float spike = 400;
  noisy.at(30, 30, red) += spike / 2;
  noisy.at(30, 30, noise) += spike / 2;
  const Image out = denoise(noisy).picture;
  const std::size_t denoised = *out.find_channel("denoised.indirect.R");
  double around = 0;
  for (int y = 22; y < 39; ++y)
    for (int x = 22; x < 39; ++x) {
      const double excess = static_cast<double>(out.at(x, y, denoised)) - smooth(x, y);
      around += excess;
      EXPECT_LT(excess, 8) << x << " " << y;
    }
  EXPECT_LT(around, 1.1 * static_cast<double>(spike) / 2);
}

// Sun glints on water: pixels a thousand times as bright as the picture, some of them in each half. Smoothing would
// turn each into a white spot.
TEST(Denoise, LeavesGlintsWhereTheyAre) {
  Image noisy = picture_of({64, 64, {{"emission", smooth, fifth}}});
  const std::size_t first = *noisy.find_channel("emission.R"), noise = *noisy.find_channel("noise.emission.R");
  for (const auto& [x, y, half] : {std::array{30, 30, 1}, {31, 33, -1}, {33, 31, 1}, {30, 34, -1}})
    for (std::size_t c = 0; c < 3; ++c) {
      noisy.at(x, y, c) += 1000;
      noisy.at(x, y, first + c) += 1000;
      noisy.at(x, y, noise + c) += static_cast<float>(1000 * half);
    }
  const Image clean = denoise(noisy).picture;
  const std::size_t red = *clean.find_channel("denoised.R");
  for (int y = 20; y < 45; ++y)
    for (int x = 20; x < 45; ++x)
      if (x < 28 || x > 35 || y < 28 || y > 36) {
        EXPECT_NEAR(clean.at(x, y, red), smooth(x, y), 1) << x << ' ' << y;
      }
}

TEST(Denoise, KnowsItsError) {
  const auto light = [](int x, int y) { return smooth(x, y) + step(x, y); };
  const Scene scene{96, 96, {{"direct", light, fifth}}};
  double expected = 0, found = 0;
  constexpr unsigned seeds = 4;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const DenoisedPicture out = denoise(picture_of(scene, seed));
    double mean = 0;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 96; ++x) {
        const double d =
            static_cast<double>(out.picture.at(x, y, *out.picture.find_channel("denoised.R"))) - light(x, y);
        const double scale = light(x, y) * light(x, y);
        mean += d * d / scale / (96 * 96);
      }
    found += mean / seeds;
    expected += out.error.error * out.error.error / seeds;
    EXPECT_TRUE(out.error.is_known());
    EXPECT_GE(out.error.bound, out.error.error);
  }
  EXPECT_GT(std::sqrt(expected / found), 0.7);
  EXPECT_LT(std::sqrt(expected / found), 2);
}

// A picture with the layers `bias` and `noise.bias`: a constant bias, estimated with noise of this standard deviation
// in each half.
Image with_bias(const Image& picture, double bias, double sigma) {
  Image layers(picture.width, picture.height,
               {"bias.R", "bias.G", "bias.B", "noise.bias.R", "noise.bias.G", "noise.bias.B"});
  std::mt19937 rng(7);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<double> a = noise_field(picture.width, picture.height, 3, rng),
                              b = noise_field(picture.width, picture.height, 3, rng);
    for (std::size_t i = 0; i < a.size(); ++i) {
      layers.pixels[6 * i + c] = static_cast<float>(bias + sigma * (a[i] + b[i]) / 2);
      layers.pixels[6 * i + 3 + c] = static_cast<float>(sigma * (a[i] - b[i]) / 2);
    }
  }
  return with_layers(picture, layers);
}

// The bias is noisy as well: its noise is no error of the picture.
TEST(Denoise, AddsTheBiasToItsErrorWithoutTheNoiseOfTheBias) {
  const auto light = [](int, int) { return 1.0; };
  const Image picture = picture_of({128, 128, {{"caustic", light, fifth}}});
  const auto error_with = [&](double bias, double sigma) { return denoise(with_bias(picture, bias, sigma)).error; };
  const ErrorEstimate without = denoise(picture).error, noisy = error_with(0, 0.5), biased = error_with(0.3, 0.5);
  EXPECT_LT(noisy.error, without.error + 0.1);
  EXPECT_LT(noisy.bound, 0.25);
  EXPECT_NEAR(biased.error, std::hypot(without.error, 0.3), 0.06);
  EXPECT_GT(biased.bound, biased.error);
  EXPECT_FALSE(denoise(with_bias(picture, 0.3, 0.5)).picture.find_channel("denoised.bias.R"));  // no layer of light
}

// The errors of dark pixels beside bright lines are relative to the dark light.
TEST(Denoise, KnowsItsErrorBesideBrightLines) {
  const auto lines = [](int x, int) { return x % 8 == 0 ? 8.0 : 0.5; };
  const auto sigma = [](int, int) { return 0.4; };
  double found = 0, expected = 0;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const DenoisedPicture out = denoise(picture_of({96, 96, {{"caustic", lines, sigma}}}, seed));
    const std::size_t red = *out.picture.find_channel("denoised.R");
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 96; ++x) {
        const double r = lines(x, y), d = static_cast<double>(out.picture.at(x, y, red)) - r;
        found += d * d / (r * r + 0.01 * 1.44 * 1.44) / (96 * 96);
      }
    expected += out.error.error * out.error.error;
  }
  EXPECT_GT(std::sqrt(expected / found), 0.8);
  EXPECT_LT(std::sqrt(expected / found), 1.6);
}

TEST(Denoise, IsTheSameForAnyNumberOfThreads) {
  const Image noisy = picture_of({150, 70, {{"direct", smooth, fifth}, {"caustic", step, fifth}}});
  std::vector<std::vector<float>> results, previews;
  for (const unsigned threads : {1u, 2u, 3u}) {
    const ThreadLimit limit(threads);
    results.push_back(denoise(noisy).picture.pixels);
    previews.push_back(preview_without_noise(noisy).pixels);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
  EXPECT_EQ(previews[0], previews[1]);
  EXPECT_EQ(previews[0], previews[2]);
}

// Media layers repeat light of other layers: it is not counted twice.
TEST(Denoise, APreviewIsTheWholePictureWithLessNoise) {
  const auto light = [](int x, int y) { return smooth(x, y) + step(x, y); };
  const Image noisy =
      picture_of({96, 64, {{"direct", smooth, fifth}, {"caustic", step, fifth}, {"media", smooth, fifth}}});
  const Image preview = preview_without_noise(noisy);
  EXPECT_EQ(preview.channels, (std::vector<std::string>{"R", "G", "B"}));
  const double before = mean_square(noisy, "", light), after = mean_square(preview, "", light);
  EXPECT_GT(before / after, 6);
  EXPECT_LT(mean_square(denoise(noisy).picture, "denoised.", light), after);
}

// Pixels right of a tile's border do not depend on those far left of it.
TEST(Denoise, TilesHaveNoSeams) {
  const Scene scene{1100, 24, {{"direct", smooth, fifth}}};
  const Image noisy = picture_of(scene);
  Image right(300, 24, noisy.channels);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 300; ++x)
      for (std::size_t c = 0; c < noisy.channel_count(); ++c) right.at(x, y, c) = noisy.at(800 + x, y, c);
  const Image whole = denoise(noisy).picture, part = denoise(right).picture;
  const std::size_t red = *whole.find_channel("denoised.R");
  for (int y = 0; y < 24; ++y)
    for (int x = 1000; x < 1050; ++x)
      EXPECT_NEAR(whole.at(x, y, red), part.at(x - 800, y, red), 0.02f) << x << " " << y;
}

TEST(Denoise, TakesAnySizeAndWindow) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {5, 2}, {33, 31}}) {
    Image noisy = picture_of({width, height, {{"direct", smooth, fifth}}});
    noisy.window = {3, 4, 100, 80};
    const Image out = denoise(noisy).picture;
    EXPECT_EQ(out.width, width);
    EXPECT_EQ(out.window, noisy.window);
    for (const float v : out.pixels) EXPECT_TRUE(std::isfinite(v));
    const Image preview = preview_without_noise(noisy);
    EXPECT_EQ(preview.width, width);
    EXPECT_EQ(preview.window, noisy.window);
    for (const float v : preview.pixels) EXPECT_TRUE(std::isfinite(v));
  }
}

TEST(Denoise, CountsWhatIsNotFiniteAsBlack) {
  Image noisy = picture_of({32, 32, {{"direct", smooth, fifth}}});
  noisy.at(7, 7, *noisy.find_channel("direct.R")) = std::numeric_limits<float>::quiet_NaN();
  noisy.at(8, 7, *noisy.find_channel("noise.direct.G")) = std::numeric_limits<float>::infinity();
  const Image out = denoise(noisy).picture;
  const std::size_t first = *out.find_channel("denoised.R");
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      for (std::size_t c = first; c < out.channel_count(); ++c) ASSERT_TRUE(std::isfinite(out.at(x, y, c)));
}

TEST(Denoise, ReplacesWhatWasDenoisedBefore) {
  const Image noisy = picture_of({32, 32, {{"direct", smooth, fifth}}});
  const Image once = denoise(noisy).picture, twice = denoise(once).picture;
  EXPECT_EQ(once.channels, twice.channels);
  EXPECT_EQ(once.pixels, twice.pixels);
  const Image clean = with_denoised_light(once);
  EXPECT_FALSE(clean.find_channel("denoised.R") || clean.find_channel("noise.direct.R"));
  EXPECT_EQ(clean.at(5, 6, *clean.find_channel("direct.G")), once.at(5, 6, *once.find_channel("denoised.direct.G")));
  EXPECT_EQ(clean.at(5, 6, 2), once.at(5, 6, *once.find_channel("denoised.B")));
  EXPECT_FALSE(can_denoise(clean));
}

TEST(Denoise, RefusesPicturesWithoutHalves) {
  EXPECT_THROW(denoise(Image(4, 4, {"R", "G", "B"})), Error);
  EXPECT_THROW(preview_without_noise(Image(4, 4, {"R", "G", "B"})), Error);
  Image single = picture_of({8, 8, {{"direct", smooth, fifth}}});
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) single.at(x, y, *single.find_channel("noise.share")) = 1;
  EXPECT_THROW(denoise(single), Error);
  EXPECT_THROW(preview_without_noise(single), Error);
}

// Files from which another program has removed channels.
TEST(Denoise, RefusesPicturesOfWhichLightIsMissing) {
  const Image whole = picture_of({16, 8, {{"direct", smooth, fifth}, {"caustic", smooth, fifth}}});
  const auto without = [&](const std::string& prefix) {
    Image part = whole;
    for (std::string& channel : part.channels)
      if (channel.starts_with(prefix)) channel = "other." + channel;
    return part;
  };
  EXPECT_NO_THROW(denoise(without("nothing")));
  for (const char* const prefix : {"noise.caustic", "noise.caustic.G", "caustic.B", "noise.direct", "noise.position.Y"})
    EXPECT_THROW(denoise(without(prefix)), Error) << prefix;
}

}  // namespace
}  // namespace lanthorn::denoise_test
