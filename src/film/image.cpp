// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/image.h"

#include <algorithm>
#include <array>

namespace lanthorn {
namespace {

constexpr std::array<std::string_view, 4> color_channels{"R", "G", "B", "A"};

/// The layer that a channel belongs to.
std::string_view layer_of(std::string_view channel) {
  if (is_spectral_channel(channel)) return channel;
  const std::size_t dot = channel.rfind('.');
  if (dot != std::string_view::npos) return channel.substr(0, dot);
  const bool color = std::find(color_channels.begin(), color_channels.end(), channel) != color_channels.end();
  return color || channel.empty() || channel == "Y" ? "color" : channel;
}

std::optional<std::vector<std::size_t>> find_all(const Image& image, std::string_view prefix,
                                                 std::initializer_list<std::string_view> components) {
  std::vector<std::size_t> found;
  for (const std::string_view component : components) {
    const auto channel = image.find_channel(std::string(prefix).append(component));
    if (!channel) return std::nullopt;
    found.push_back(*channel);
  }
  return found;
}

std::optional<std::vector<std::size_t>> find_layer(const Image& image, std::string_view name) {
  if (name == "color") {
    if (const auto rgb = find_all(image, "", {"R", "G", "B"})) return rgb;
    for (const std::string_view grey : {"Y", ""})
      if (const auto one = image.find_channel(grey)) return std::vector<std::size_t>(3, *one);
    return std::nullopt;
  }
  const std::string prefix = std::string(name) + ".";
  if (const auto rgb = find_all(image, prefix, {"R", "G", "B"})) return rgb;
  if (const auto xyz = find_all(image, prefix, {"X", "Y", "Z"})) return xyz;
  if (const auto z = find_all(image, prefix, {"Z"})) return z;
  return find_all(image, name, {""});
}

}  // namespace

Image::Image(int width_, int height_, std::vector<std::string> channels_)
    : width(width_),
      height(height_),
      channels(std::move(channels_)),
      pixels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * channels.size()) {}

std::optional<std::size_t> Image::find_channel(std::string_view name) const {
  const auto found = std::find(channels.begin(), channels.end(), name);
  if (found == channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - channels.begin());
}

std::optional<Image> select_layer(const Image& image, std::string_view name) {
  const auto from = find_layer(image, name);
  if (!from) return std::nullopt;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < from->size(); ++c) {
    const std::string& channel = image.channels[(*from)[c]];
    names.push_back(name == "color" ? std::string(color_channels[c]) : channel);
  }
  Image layer(image.width, image.height, std::move(names));
  layer.window = image.window;
  const std::size_t pixel_count = layer.pixels.size() / from->size();
  for (std::size_t i = 0; i < pixel_count; ++i)
    for (std::size_t c = 0; c < from->size(); ++c)
      layer.pixels[i * from->size() + c] = image.pixels[i * image.channel_count() + (*from)[c]];
  return layer;
}

Image with_layers(const Image& picture, const Image& layers) {
  const std::size_t own = picture.channel_count(), added = layers.channel_count();
  std::vector<std::string> channels = picture.channels;
  channels.insert(channels.end(), layers.channels.begin(), layers.channels.end());
  Image out(picture.width, picture.height, std::move(channels));
  out.window = picture.window;
  for (std::size_t i = 0; i * own < picture.pixels.size(); ++i) {
    float* const to = std::copy_n(&picture.pixels[i * own], own, &out.pixels[i * (own + added)]);
    std::copy_n(&layers.pixels[i * added], added, to);
  }
  return out;
}

bool is_noise_channel(std::string_view channel) { return channel.starts_with("noise."); }

bool is_spectral_channel(std::string_view channel) { return channel.starts_with("S0.") && channel.ends_with("nm"); }

std::vector<std::string> layer_names(const Image& image) {
  std::vector<std::string> names;
  for (const std::string& channel : image.channels) {
    const std::string_view layer = layer_of(channel);
    if (std::find(names.begin(), names.end(), layer) == names.end()) names.emplace_back(layer);
  }
  return names;
}

}  // namespace lanthorn
