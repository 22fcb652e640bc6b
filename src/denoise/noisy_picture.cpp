// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "denoise/noisy_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lanthorn/error.h"

namespace lanthorn::denoising {

namespace {

const std::string noise_prefix = "noise.", share_channel = "noise.share";

float finite(float value) { return std::isfinite(value) ? value : 0.0f; }

bool has_layer_with_noise(const Image& picture, const std::string& layer, const std::array<const char*, 3>& names) {
  return has_layer(picture, layer, names) && has_layer(picture, noise_prefix + layer, names);
}

}  // namespace

bool has_layer(const Image& picture, const std::string& layer, const std::array<const char*, 3>& names) {
  for (const char* const name : names)
    if (!picture.find_channel(layer + "." + name)) return false;
  return true;
}

std::vector<std::string> light_layers(const Image& picture) {
  std::vector<std::string> layers;
  for (const std::string& channel : picture.channels) {
    if (!channel.starts_with(noise_prefix) || !channel.ends_with(".R")) continue;
    const std::string layer = channel.substr(noise_prefix.size(), channel.size() - noise_prefix.size() - 2);
    if (layer != "albedo" && layer != "bias" && has_layer_with_noise(picture, layer, components))
      layers.push_back(layer);
  }
  return layers;
}

bool has_halves(const Image& picture) {
  for (const FeatureLayer& layer : feature_layers)
    if (!has_layer_with_noise(picture, layer.name, layer.components)) return false;
  return picture.find_channel(share_channel) && picture.find_channel("samples") && select_layer(picture, "color") &&
         !light_layers(picture).empty();
}

bool is_repeated(const std::string& layer) { return layer == "media"; }

std::vector<Tile> tiles_of(const Part& part, int width, int height) {
  // Multiples of the pyramid's coarsest pixels and of the spacing of regressions.
  constexpr int size = 1024, margin = 96;
  const int right = part.x + part.width, bottom = part.y + part.height;
  std::vector<Tile> tiles;
  for (int y = part.y; y < bottom; y += size)
    for (int x = part.x; x < right; x += size) {
      Tile t{
          x, y, std::min(size, right - x), std::min(size, bottom - y), std::max(0, x - margin), std::max(0, y - margin),
          0, 0};
      t.outer_width = std::min(width, x + size + margin) - t.outer_x;
      t.outer_height = std::min(height, y + size + margin) - t.outer_y;
      tiles.push_back(t);
    }
  return tiles;
}

NoisyPicture::NoisyPicture(const Image& picture) : picture_(picture) {
  const std::size_t share = channel_of(share_channel), samples = channel_of("samples");
  const std::array<std::size_t, color_channels> color{channel_of("R"), channel_of("G"), channel_of("B")};
  const auto value = [&](std::size_t pixel, std::size_t channel) {
    return static_cast<double>(finite(picture.pixels[pixel * picture.channel_count() + channel]));
  };
  double first = 0, all = 0, light = 0;
  for (std::size_t i = 0; i < pixel_count(); ++i) {
    first += value(i, share) * value(i, samples);
    all += value(i, samples);
    for (const std::size_t c : color) light += value(i, c) / color_channels;
  }
  check_sum(light);
  const auto own = all > 0 ? std::clamp(static_cast<float>(first / all), 0.0f, 1.0f) : 0.0f;
  if (own == 0 || own == 1)
    throw Error("a picture of a single pass cannot be denoised: the noise is measured from differences between passes");
  shares_ = {own, 1 - own};
  fewest_passes_ = std::min(own, 1 - own) * all / static_cast<double>(pixel_count());
  mean_ = static_cast<float>(light / static_cast<double>(pixel_count()));
}

void NoisyPicture::check_sum(double light) const {
  constexpr double rounding = 1e-2;  // of files in half precision
  const std::vector<std::string> layers = light_layers(picture_);
  double sum = 0;
  for (const std::string& layer : layers) {
    if (is_repeated(layer)) continue;
    for (const char* const c : components) {
      const std::size_t channel = channel_of(layer + "." + c);
      for (std::size_t i = 0; i < pixel_count(); ++i)
        sum += static_cast<double>(finite(picture_.pixels[i * picture_.channel_count() + channel])) / color_channels;
    }
  }
  if (std::fabs(sum - light) > rounding * std::fabs(light))
    throw Error(
        fmt::format("the layers with known noise ({}) contain {:.3g} times the light of color; expected all of it",
                    fmt::join(layers, ", "), sum / light));
}

Plane NoisyPicture::read(const Tile& tile, const std::string& name) const {
  const std::size_t channel = channel_of(name);
  Plane plane(tile.outer_width, tile.outer_height);
  plane.for_each_row([&](int y) {
    float* const to = plane.row(y);
    for (int x = 0; x < plane.width(); ++x) to[x] = finite(picture_.at(tile.outer_x + x, tile.outer_y + y, channel));
  });
  return plane;
}

// Reads all channels at once, since they are adjacent in memory.
Halves NoisyPicture::read_halves(const Tile& tile, const std::string& layer,
                                 const std::array<const char*, 3>& names) const {
  Halves halves;
  for (ColorPlanes& half : halves) half.fill(Plane(tile.outer_width, tile.outer_height));
  std::array<std::size_t, color_channels> all, noise;
  for (std::size_t c = 0; c < color_channels; ++c) {
    all[c] = channel_of(layer + "." + names[c]);
    noise[c] = channel_of(noise_prefix + layer + "." + names[c]);
  }
  const float ratio = shares_[0] / shares_[1];
  halves[0][0].for_each_row([&](int y) {
    for (int x = 0; x < tile.outer_width; ++x) {
      const float* const from = &picture_.pixels[picture_.index(tile.outer_x + x, tile.outer_y + y)];
      for (std::size_t c = 0; c < color_channels; ++c) {
        const float mean = finite(from[all[c]]), difference = finite(from[noise[c]]);
        halves[0][c].row(y)[x] = mean + difference;
        halves[1][c].row(y)[x] = mean - ratio * difference;
      }
    }
  });
  return halves;
}

float NoisyPicture::least_scale() const {
  constexpr float dark = 0.01f, tiny = 1e-30f;
  return dark * sqr(mean_) + tiny;
}

ErrorScale NoisyPicture::scale_of(const Tile& tile) const {
  constexpr float bright = 10;
  const float white = bright * mean_;
  Plane light(tile.outer_width, tile.outer_height);
  for (const char* const c : components) {
    const Plane color = read(tile, c);
    light.fill([&](std::size_t i) { return light[i] + std::min(color[i], white) / 3; });
  }
  light = box_filtered(light, scale_radius);
  light.fill([&](std::size_t i) { return sqr(light[i]) + least_scale(); });
  return {std::move(light), white};
}

ColorPlanes NoisyPicture::demodulation_of(const std::array<FeaturePlanes, 2>& features) const {
  constexpr float dark = 0.1f;  // darker surfaces reflect more light than their albedo suggests
  ColorPlanes factors;
  for (std::size_t c = 0; c < color_channels; ++c) {
    const Plane &a = features[0].values[c], &b = features[1].values[c];
    factors[c] = Plane::of(a.width(), a.height(), [&](std::size_t i) {
      return 1 / (std::max(0.0f, shares_[0] * a[i] + shares_[1] * b[i]) + dark);
    });
  }
  return factors;
}

}  // namespace lanthorn::denoising
