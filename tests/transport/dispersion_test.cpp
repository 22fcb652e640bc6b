// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Dispersive objects are colourless on average, although each pass of most methods uses few wavelengths.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "support/render_scene.h"

namespace lanthorn::dispersion_test {
namespace {

// A lone clear ball under a white sky is invisible, whatever its index of refraction. It fills the picture.
const std::string ball_in_white_sky =
    "LookAt 0 0 -8  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" [8]\nPixelFilter \"box\"\n"
    "Film \"rgb\" \"integer xresolution\" [12] \"integer yresolution\" [12]\nWorldBegin\n"
    "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"dielectric\" \"spectrum eta\" \"glass-BK7\"\n"
    "Shape \"sphere\"\n";

std::array<double, 3> mean_of(const Image& image) {
  std::array<double, 3> mean{};
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    mean[i % 3] += static_cast<double>(image.pixels[i]) / (static_cast<double>(image.pixels.size()) / 3);
  return mean;
}

class Dispersion : public testing::TestWithParam<const char*> {};

// Every path through the ball has radiance 1: only the colours of the wavelengths differ. Each half of the passes
// contains a block of them (`wavelengths_in_order`).
TEST_P(Dispersion, IsWhiteAfterThirtyTwoPasses) {
  const Scene scene = test::scene_from_text(ball_in_white_sky);
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    RenderOptions options = test::options_for(GetParam(), 32);
    options.seed = seed;
    options.color = ColorMode::spectral;
    options.photons = 2'000;
    if (test::has_radius(GetParam())) options.set["radius"] = "0.1";
    const std::array<double, 3> mean = mean_of(*select_layer(test::render_image(scene, options), "color"));
    for (const double channel : mean) EXPECT_NEAR(channel, 1, 0.01) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Dispersion,
                         testing::Values("probppm", "sppm", "ppm", "vcm", "bdpt", "bpm", "photonmap",
                                         "reversephotonmap"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace lanthorn::dispersion_test
