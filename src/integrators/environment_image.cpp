// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/environment_image.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/light.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

namespace {

/// Width, in texels, of an equirectangular image as fine as the finest of the scene's infinite lights; limited to bound
/// memory and time.
int environment_width(const Scene& scene) {
  constexpr float least = 64, most = 4096;
  float width = least;
  for (const std::uint32_t light : scene.infinite_lights())
    width = std::max(width, 4 * texels_across_right_angle(scene.lights()[light]));
  return 2 * static_cast<int>(std::min(std::ceil(width / 2), most / 2));
}

}  // namespace

Image environment_image(const Scene& scene) {
  const int width = environment_width(scene);
  constexpr int most_across = 8192;
  const int pieces = std::clamp(most_across / width, 2, 4);
  Image image(width, width / 2, {"R", "G", "B"});
  const Wavelengths w = Wavelengths::rgb(0.5f);
  const Point from = scene.bounding_sphere().centre;
  const auto radiance = [&](int column, int row) {
    const float step = 2 * pi / static_cast<float>(width * pieces);
    const float polar = step * (static_cast<float>(row) + 0.5f),
                azimuth = step * (static_cast<float>(column) + 0.5f) - pi;
    const Direction d(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
    Spectrum sum;
    for (const std::uint32_t light : scene.infinite_lights())
      sum += emitted_infinite(scene.lights()[light], from, d, w);
    return sum;
  };
  parallel_for(0, image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      Spectrum sum;
      for (int i = 0; i < pieces * pieces; ++i) sum += radiance(x * pieces + i % pieces, y * pieces + i / pieces);
      for (std::size_t c = 0; c < 3; ++c) image.at(x, y, c) = sum.v[c] / static_cast<float>(pieces * pieces);
    }
  });
  return image;
}

}  // namespace lanthorn
