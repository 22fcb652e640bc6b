// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "lanthorn/image_file.h"

namespace lanthorn {

namespace {

constexpr float darkest_albedo = 0.01f;  // dividing by less would amplify noise
constexpr double fewest_lit = 0.01;      // fraction of the pixels

float brightest(const Image& layer, std::size_t i) {
  return std::max({layer.pixels[i], layer.pixels[i + 1], layer.pixels[i + 2]});
}

// Illumination of the visible surfaces: the light that they scatter, divided by their albedo. One value for each pixel
// with a lit surface.
std::vector<float> incident_light(const Image& image) {
  const auto direct = select_layer(image, "direct"), indirect = select_layer(image, "indirect"),
             caustic = select_layer(image, "caustic"), albedo = select_layer(image, "albedo");
  std::vector<float> values;
  if (!direct || !indirect || !caustic || !albedo) return values;
  for (std::size_t i = 0; i + 2 < albedo->pixels.size(); i += 3) {
    const float reflectance = brightest(*albedo, i);
    if (!(reflectance > darkest_albedo)) continue;
    std::array<float, 3> scattered{};
    for (std::size_t c = 0; c < 3; ++c)
      scattered[c] = direct->pixels[i + c] + indirect->pixels[i + c] + caustic->pixels[i + c];
    values.push_back(*std::max_element(scattered.begin(), scattered.end()) / reflectance);
  }
  return values;
}

std::vector<float> colours(const Image& image) {
  std::vector<float> values;
  if (const auto color = select_layer(image, "color"))
    for (std::size_t i = 0; i + 2 < color->pixels.size(); i += 3) values.push_back(brightest(*color, i));
  return values;
}

// The value that the fraction 1 - `share` of the values exceeds.
float quantile(std::vector<float> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The brightness exceeded by a tenth of the values, ignoring black ones. nullopt if fewer than `fewest` remain.
std::optional<float> bright_level(std::vector<float> values, double fewest) {
  std::erase_if(values, [](float x) { return !(x > 0) || !std::isfinite(x); });
  if (values.empty() || static_cast<double>(values.size()) < fewest) return {};
  return quantile(std::move(values), 0.9);
}

}  // namespace

float measured_exposure(const Image& image) {
  const double pixels = static_cast<double>(image.width) * image.height;
  std::optional<float> white = bright_level(incident_light(image), fewest_lit * pixels);
  if (!white) white = bright_level(colours(image), 0);
  if (!white) return 0;
  const float stops = -std::round(10 * std::log2(*white)) / 10;
  return std::clamp(stops, -DisplaySettings::largest_exposure, DisplaySettings::largest_exposure);
}

float brightest_level(const Image& image) {
  std::vector<float> values = colours(layer_names(image).size() == 1 ? as_color(image) : image);
  std::erase_if(values, [](float x) { return !std::isfinite(x); });
  return values.empty() ? 0 : quantile(std::move(values), 0.999);
}

}  // namespace lanthorn
