// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Spectral films measure the spectra of lights and surfaces.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "integrators/integrator.h"
#include "lanthorn/error.h"
#include "spectrum/cie.h"
#include "support/render_scene.h"
#include "support/statistics.h"

namespace lanthorn::spectral_film_test {
namespace {

constexpr int side = 16;

// A wide disk whose reflectance rises with the wavelength, under a sky of D65.
Scene disk_under_sky(const SpectralBuckets& buckets) {
  return test::scene_from_text(fmt::format(R"(
LookAt 0 0 2  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
Film "spectral" "integer xresolution" [{0}] "integer yresolution" [{0}] "integer nbuckets" [{1}] "float lambdamin" [{2}] "float lambdamax" [{3}]
PixelFilter "box" "float xradius" [0.5] "float yradius" [0.5]
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
Material "diffuse" "spectrum reflectance" [360 0.1 830 0.9]
Shape "disk" "float radius" [5]
)",
                                           side, buckets.count, buckets.low, buckets.high));
}

double radiance(double nm) {
  return static_cast<double>(named_spectrum("stdillum-D65")->at(static_cast<float>(nm))) *
         (0.1 + 0.8 * (nm - 360) / 470);
}

double mean_radiance(const SpectralBuckets& buckets, std::size_t bucket) {
  const int steps = 1000;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    sum += radiance(buckets.centre(bucket) + ((i + 0.5) / steps - 0.5) * static_cast<double>(buckets.width()));
  return sum / steps;
}

double mean_of_channel(const Image& image, std::size_t channel) {
  double sum = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) sum += static_cast<double>(image.at(x, y, channel));
  return sum / (side * side);
}

std::size_t first_bucket(const Image& image) {
  const auto found = std::find_if(image.channels.begin(), image.channels.end(), is_spectral_channel);
  return static_cast<std::size_t>(found - image.channels.begin());
}

// If passes share wavelengths, buckets have standard errors of up to 1.4 %: the largest of 66 deviations was 3.4 %.
TEST(SpectralFilm, EveryIntegratorFindsTheSpectrum) {
  const SpectralBuckets buckets{6, 400, 700};
  const Scene scene = disk_under_sky(buckets);
  for (const IntegratorInfo& info : integrator_registry()) {
    if (info.name == "splitsum") continue;  // its maps are RGB: the sky's spectrum is upsampled
    RenderOptions options = test::options_for(info.name, 64, 3);
    if (info.name == "bpm") options.set["radius"] = "0.5";  // only photons, and few of them: the disk is small
    options.max_depth = 1;
    options.photons = 20000;
    const Image image = test::render_image(scene, options);
    for (std::size_t b = 0; b < buckets.count; ++b) {
      const double expected = mean_radiance(buckets, b);
      EXPECT_TRUE(test::within(mean_of_channel(image, first_bucket(image) + b), expected, 0.09 * expected))
          << info.name << ", " << image.channels[first_bucket(image) + b];
    }
  }
}

// The variation of a spectrum within a bucket is 0.6 %, the standard error 0.05 %.
TEST(SpectralFilm, BucketsAddUpToTheColour) {
  const SpectralBuckets buckets{94, 360, 830};
  const Image image = test::render_image(disk_under_sky(buckets), test::options_for("path", 64, 3));
  Tristimulus sum;
  for (std::size_t i = 0; i < spectrum_samples; ++i) {
    const std::size_t bucket = buckets.find(lambda_min + static_cast<float>(i)).value();
    sum = sum + mean_of_channel(image, first_bucket(image) + bucket) * cie_1931[i];
  }
  const Tristimulus rgb = xyz_to_rec709 * ((1 / cie_y_integral) * sum);
  EXPECT_TRUE(test::within(mean_of_channel(image, 0), rgb.x, 0.01 * rgb.x));
  EXPECT_TRUE(test::within(mean_of_channel(image, 1), rgb.y, 0.01 * rgb.y));
  EXPECT_TRUE(test::within(mean_of_channel(image, 2), rgb.z, 0.01 * rgb.z));
}

TEST(SpectralFilm, NeedsSpectralRendering) {
  const Scene scene = disk_under_sky({});
  RenderOptions options = test::options_for("path", 1);
  EXPECT_EQ(test::plan_render(scene, options).settings.color, ColorMode::spectral);
  options.color = ColorMode::rgb;
  EXPECT_THROW(test::plan_render(scene, options), Error);
}

}  // namespace
}  // namespace lanthorn::spectral_film_test
