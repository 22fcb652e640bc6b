// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Dispersive objects are colourless on average, although each pass of most methods uses few wavelengths.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "support/render_scene.h"
#include "support/runs.h"

namespace lanthorn::dispersion_test {
namespace {

// A lone clear ball under a white sky is invisible, whatever its index of refraction. It fills the picture.
const std::string ball_in_white_sky =
    R"(LookAt 0 0 -8  0 0 0  0 1 0
Camera "perspective" "float fov" [8]
PixelFilter "box"
Film "rgb" "integer xresolution" [12] "integer yresolution" [12]
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material "dielectric" "spectrum eta" "glass-BK7"
Shape "sphere"
)";

std::array<double, 3> mean_of(const Image& image) {
  std::array<double, 3> mean{};
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    mean[i % 3] += static_cast<double>(image.pixels[i]) / (static_cast<double>(image.pixels.size()) / 3);
  return mean;
}

class Dispersion : public testing::TestWithParam<const char*> {};

// Every path through the ball has radiance 1: only the colours of the wavelengths differ. The pixels of a pass share
// its wavelengths as heroes (`PassDraw`), so that the mean of the picture is right from the first pass on. In a pixel,
// each half of the passes contains a block of heroes (`wavelengths_in_order`).
TEST_P(Dispersion, IsWhiteOnAverageAfterOnePassAndInEachPixelAfterThirtyTwo) {
  const Scene scene = test::scene_from_text(ball_in_white_sky);
  for (const std::uint64_t passes : {1, 2, 4, 32})
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      RenderOptions options = test::options_for(GetParam(), passes);
      options.seed = seed;
      options.color = ColorMode::spectral;
      options.photons = 2'000;
      if (test::has_radius(GetParam())) options.set["radius"] = "0.1";
      const Image picture = *select_layer(test::render_image(scene, options), "color");
      for (const double channel : mean_of(picture)) EXPECT_NEAR(channel, 1, 0.01) << passes << ", seed " << seed;
      if (passes < 32) continue;
      for (const float channel : picture.pixels) EXPECT_NEAR(channel, 1, 0.01) << "seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Dispersion,
                         testing::Values("probppm", "sppm", "ppm", "vcm", "bdpt", "bpm", "photonmap",
                                         "reversephotonmap"),
                         [](const auto& tested) { return std::string(tested.param); });

// A dispersive ball focuses white sunlight onto a floor. The light paths of a pass share its wavelengths as heroes.
// With about 20,000 photons in the caustic, the standard deviation of its colour is 2 %; with a single hero for the
// light paths of each part of a pass, the colour would be off by half.
class DispersedLight : public testing::TestWithParam<const char*> {};

TEST_P(DispersedLight, IsWhiteAfterOnePass) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 0 1.8  0 0 0  0 1 0
Camera "perspective" "float fov" [60]
Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
WorldBegin
LightSource "distant" "rgb L" [1 1 1] "point3 from" [0 0 1] "point3 to" [0 0 0]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "bilinearmesh" "point3 P" [-1.5 -1.5 0  1.5 -1.5 0  -1.5 1.5 0  1.5 1.5 0]
Translate 0 0 3
Material "dielectric" "spectrum eta" "glass-BK7"
Shape "sphere"
)");
  RenderOptions options = test::options_for(GetParam(), 1);
  options.color = ColorMode::spectral;
  options.photons = 100'000;
  if (test::has_radius(GetParam())) options.set["radius"] = "0.1";
  const std::array<double, 3> mean = mean_of(*select_layer(test::render_image(scene, options), "caustic"));
  const double grey = (mean[0] + mean[1] + mean[2]) / 3;
  EXPECT_GT(grey, 0);
  for (const double channel : mean) EXPECT_NEAR(channel / grey, 1, 0.12);
}

INSTANTIATE_TEST_SUITE_P(Methods, DispersedLight,
                         testing::Values("probppm", "sppm", "ppm", "vcm", "bdpt", "bpm", "photonmap",
                                         "reversephotonmap", "light"),
                         [](const auto& tested) { return std::string(tested.param); });

// A white ball in a ball of dispersive glass under a white sky: nothing absorbs light, so that everything has radiance
// 1. All light passes glass before and after it has scattered: eye path and light path are both dispersed, with heroes
// of their own.
class DispersedTwice : public testing::TestWithParam<const char*> {};

TEST_P(DispersedTwice, FurnaceIsWhite) {
  const Scene scene = test::scene_from_text(ball_in_white_sky +
                                            R"(Material "diffuse" "rgb reflectance" [1 1 1]
Shape "sphere" "float radius" [0.9]
)");
  RenderOptions options = test::options_for(GetParam(), 2);
  options.color = ColorMode::spectral;
  options.photons = 20'000;
  options.max_depth = 256;
  const std::vector<Image> images = test::select_layers(test::independent_renders(scene, options, 16, 0), "color");
  for (std::size_t channel = 0; channel < 3; ++channel) {
    test::Mean mean;
    for (const Image& image : images) mean.add(mean_of(image)[channel]);
    EXPECT_TRUE(test::runs_agree(mean, 1, 0.04, 0.25, test::false_alarm_rate / 3)) << channel;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, DispersedTwice,
                         testing::Values("probppm", "sppm", "vcm", "bdpt", "bpm", "photonmap", "reversephotonmap"),
                         [](const auto& tested) { return std::string(tested.param); });
INSTANTIATE_TEST_SUITE_P(Nightly, DispersedTwice, testing::Values("mlt"));

}  // namespace
}  // namespace lanthorn::dispersion_test
