// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The data that a render gives the denoiser, and the denoised result.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "lanthorn/denoise.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "lanthorn/state.h"

namespace lanthorn::denoised_render_test {
namespace {

SharedScene box() { return build_scene(read_scene(LANTHORN_SOURCE_DIR "/scenes/cornell-caustics.pbrt")); }

RenderOptions options(const std::string& integrator, int size, std::uint64_t seed = 0) {
  RenderOptions options;
  options.integrator = integrator;
  options.resolution = {size, size};
  options.color = ColorMode::rgb;
  options.seed = seed;
  return options;
}

double relative_mse(const Image& a, const std::string& layer, const Image& reference) {
  const Image found = *select_layer(a, layer), truth = *select_layer(reference, "color");
  double mean = 0, sum = 0;
  for (const float v : truth.pixels) mean += static_cast<double>(v) / static_cast<double>(truth.pixels.size());
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    const auto r = static_cast<double>(truth.pixels[i]), d = static_cast<double>(found.pixels[i]) - r;
    sum += std::min(1.0, d * d / (r * r + 0.01 * mean * mean));
  }
  return sum / static_cast<double>(truth.pixels.size());
}

// Picture plus noise equals the picture of the first half's passes.
TEST(DenoisedRender, NoiseIsWhatTheFirstHalfDiffersBy) {
  const SharedScene scene = box();
  for (const std::string method : {"path", "vcm"}) {
    Session all(scene, options(method, 16)), half(scene, options(method, 16));
    all.render({.passes = {0, 8}});
    for (const std::uint64_t pass : {0, 3, 5, 6}) half.render({.passes = {pass, pass + 1}});
    const Image picture = with_noise(all.state(), picture_of(all.state())), first = picture_of(half.state());
    ASSERT_TRUE(can_denoise(picture));
    for (const char* channel :
         {"direct.R", "indirect.G", "caustic.B", "emission.R", "albedo.G", "normal.Y", "position.X"}) {
      const std::size_t a = *picture.find_channel(channel), n = *picture.find_channel(std::string("noise.") + channel),
                        b = *first.find_channel(channel);
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
          ASSERT_NEAR(picture.at(x, y, a) + picture.at(x, y, n), first.at(x, y, b), 1e-5f * (1 + first.at(x, y, b)))
              << method << " " << channel << " " << x << " " << y;
    }
    EXPECT_FLOAT_EQ(picture.at(3, 3, *picture.find_channel("noise.share")), 0.5f);
  }
}

// Surfaces are recorded behind mirrors and glass.
TEST(DenoisedRender, PositionsAreThoseOfTheFirstSurfaceThatIsNoMirror) {
  const SharedScene scene = box();
  Session session(scene, options("path", 32));
  session.render({.passes = {0, 4}});
  const Image picture = picture_of(session.state());
  const std::size_t x = *picture.find_channel("position.X");
  Bounds seen;
  for (int row = 8; row < 24; ++row)
    for (int column = 8; column < 24; ++column) {
      const Point p{picture.at(column, row, x), picture.at(column, row, x + 1), picture.at(column, row, x + 2)};
      for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(p[c]));
      seen.extend(p);
    }
  EXPECT_GT(seen.max.x - seen.min.x, 0.1f);
}

// The pixels around a crop are in none of its pictures, and change nothing but its denoised layers.
TEST(DenoisedRender, KeepsACropThatHasAMargin) {
  const SharedScene scene = box();
  for (const std::string method : {"path", "vcm", "auto", "sppm"}) {
    RenderOptions crop = options(method, 48);
    crop.crop = {4, 12, 24, 36};
    Session plain(scene, crop);
    crop.margin = 8;
    Session with(scene, crop);
    for (Session* session : {&plain, &with}) session->render({.passes = {0, 2}});
    const Image picture = with.picture();
    EXPECT_EQ(picture.pixels, plain.picture().pixels) << method;
    EXPECT_EQ(picture.window, plain.picture().window);
    EXPECT_EQ(picture_without_error(with.state()).pixels, picture_without_error(plain.state()).pixels);
    EXPECT_EQ(estimate_error(with.state()).error, estimate_error(plain.state()).error);
    EXPECT_EQ(with_noise(with.state(), picture).pixels, with_noise(plain.state(), picture).pixels);
    EXPECT_EQ(summarize(with.state()).width, 20);
    EXPECT_FALSE(with_margin(plain.state()));
    const std::optional<Image> around = with_margin(with.state());
    ASSERT_EQ(around.has_value(), method != "sppm");
    if (!around) continue;
    EXPECT_EQ(around->window, (ImageWindow{0, 4, 48, 48}));
    EXPECT_EQ(around->width, 32);
    EXPECT_EQ(around->height, 40);
    const std::size_t red = *picture.find_channel("R");
    EXPECT_EQ(around->at(4 + 3, 8 + 5, red), picture.at(3, 5, red));
    EXPECT_EQ(summarize(with.state()).margin, 8);
  }
}

// Mean square difference of denoised layers in the outer 8 pixels of a crop of the whole picture.
double difference_at_border(const Image& part, const Image& whole) {
  constexpr int ring = 8;
  double sum = 0;
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x) {
      if (std::min({x, y, part.width - 1 - x, part.height - 1 - y}) >= ring) continue;
      for (const char* channel : {"denoised.R", "denoised.G", "denoised.B"}) {
        const std::size_t c = *part.find_channel(channel);
        const float difference =
            part.at(x, y, c) - whole.at(part.window.x + x, part.window.y + y, *whole.find_channel(channel));
        sum += static_cast<double>(difference * difference);
      }
    }
  return sum;
}

TEST(DenoisedRender, DenoisesTheBorderOfACropFromItsMargin) {
  const SharedScene scene = box();
  RenderOptions render = options("path", 96);
  Session whole(scene, render);
  render.crop = {32, 32, 64, 64};
  render.margin = denoising_margin;
  Session part(scene, render);
  for (Session* session : {&whole, &part}) session->render({.passes = {0, 4}});
  const Image of_whole = denoise(with_noise(whole.state(), whole.picture())).picture;
  const Image crop = with_noise(part.state(), part.picture());
  const DenoisedPicture with = denoise(crop, *with_margin(part.state()));
  EXPECT_EQ(with.picture.width, 32);
  EXPECT_LT(difference_at_border(with.picture, of_whole), 0.2 * difference_at_border(denoise(crop).picture, of_whole));
}

TEST(DenoisedRender, StopsWhenTheDenoisedPictureIsGood) {
  const SharedScene scene = box();
  constexpr double limit = 0.2;
  Session noisy(scene, options("path", 32)), denoised(scene, options("path", 32));
  noisy.render({.passes = {0, 256}, .noise = limit});
  DenoisedLooks looks(limit);
  const RenderStatistics statistics =
      denoised.render({.passes = {0, 256}, .noise = limit, .error_of = std::ref(looks)});
  EXPECT_LT(denoised.pass_count(), 2 * noisy.pass_count() / 3);
  const DenoisedPicture picture = denoise(with_noise(denoised.state(), picture_of(denoised.state())));
  EXPECT_LE(picture.error.bound, limit);
  ASSERT_TRUE(statistics.error);
  EXPECT_EQ(statistics.error->bound, picture.error.bound);
  EXPECT_FALSE(estimate_error(denoised.state()).is_below(limit));

  const std::optional<DenoisedLooks::Found> found = looks.take();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->passes, denoised.pass_count());
  EXPECT_EQ(found->error.error, estimate_error(denoised.state()).error);
  EXPECT_EQ(found->denoised.picture.pixels, picture.picture.pixels);

  Session resumed(scene, options("path", 32));
  resumed.render({.passes = {0, denoised.pass_count() / 2 + 1}});
  resumed.render({.passes = {0, 256}, .noise = limit, .error_of = std::ref(looks)});
  EXPECT_EQ(resumed.pass_count(), denoised.pass_count());
}

TEST(DenoisedRender, HasLessErrorByAnyMethod) {
  const SharedScene scene = box();
  constexpr int size = 48;
  Session reference(scene, options("vcm", size, 7));
  reference.render({.passes = {0, 384}});
  const Image truth = picture_of(reference.state());
  struct Case {
    std::string method;
    double gain;
  };
  for (const Case& c : {Case{"auto", 1.3}, Case{"vcm", 1.3}, Case{"probppm", 1.2}, Case{"path", 1.6}}) {
    Session session(scene, options(c.method, size));
    session.render({.passes = {0, 8}});
    const Image noisy = picture_of(session.state());
    const DenoisedPicture denoised = denoise(with_noise(session.state(), noisy));
    const double before = relative_mse(noisy, "color", truth),
                 after = relative_mse(denoised.picture, "denoised", truth);
    EXPECT_GT(before / after, c.gain) << c.method;
    EXPECT_LT(denoised.error.error, 2 * std::sqrt(after)) << c.method;
  }
}

double mean_square_of_bias(const Image& picture, bool by_halves) {
  const std::size_t bias = *picture.find_channel("bias.R"), noise = *picture.find_channel("noise.bias.R");
  double sum = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto all = static_cast<double>(picture.at(x, y, bias + c)),
                   off = by_halves ? static_cast<double>(picture.at(x, y, noise + c)) : 0.0;
        sum += (all + off) * (all - off);
      }
  return sum;
}

// In fog, few photons make the light of a pixel, and much of its estimated bias is noise, which the halves tell apart.
TEST(DenoisedRender, KnowsTheErrorOfMergedLight) {
  const SharedScene fog = build_scene(read_scene(LANTHORN_SOURCE_DIR "/scenes/ball-in-fog.pbrt"));
  constexpr int size = 32;
  Session reference(fog, options("vcm", size, 7)), session(fog, options("vcm", size));
  reference.render({.passes = {0, 128}});
  session.render({.passes = {0, 8}});
  const Image truth = picture_of(reference.state()), picture = with_noise(session.state(), session.picture());
  EXPECT_LT(mean_square_of_bias(picture, true), 0.5 * mean_square_of_bias(picture, false));
  const DenoisedPicture denoised = denoise(picture);
  const double of_reference = estimate_error(reference.state()).noise;
  const auto error = [&](const Image& found, const char* layer) {
    return std::sqrt(relative_mse(found, layer, truth) - of_reference * of_reference);
  };
  const double noisy = error(picture, "color"), clean = error(denoised.picture, "denoised");
  EXPECT_LT(clean, 0.65 * noisy);
  EXPECT_GT(denoised.error.bound, clean);
  EXPECT_LT(denoised.error.bound, 0.6 * estimate_error(session.state()).bound);
}

}  // namespace
}  // namespace lanthorn::denoised_render_test
