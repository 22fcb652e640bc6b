// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lanthorn {

/// A part of a picture in pixels: [x, x + width) by [y, y + height), y downwards, inside a picture of full_width by
/// full_height.
struct ImageWindow {
  int x = 0;
  int y = 0;
  int full_width = 0;
  int full_height = 0;
  friend bool operator==(const ImageWindow&, const ImageWindow&) = default;
};

/// A picture of named float channels, interleaved, rows from the top. Colours are linear (see `Rgb`).
///
/// A layer is a group of channels in OpenEXR's naming: `color` is R, G, B; another layer NAME is NAME.R, NAME.G, NAME.B
/// (colours), NAME.X, NAME.Y, NAME.Z (vectors), or NAME.Z or NAME alone (one channel). Each spectral channel
/// (S0.550,5nm), which spectral films write, is a separate layer.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels;
  std::vector<float> pixels;  ///< width * height * channels.size() values
  ImageWindow window;         ///< full size 0: the picture is not cropped

  Image() = default;
  /// All pixels 0. `width`, `height` >= 0.
  Image(int width_, int height_, std::vector<std::string> channels_);

  std::size_t channel_count() const { return channels.size(); }
  std::size_t index(int x, int y, std::size_t channel = 0) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               channels.size() +
           channel;
  }
  float& at(int x, int y, std::size_t channel) { return pixels[index(x, y, channel)]; }
  float at(int x, int y, std::size_t channel) const { return pixels[index(x, y, channel)]; }

  /// Position of a channel by its exact name.
  std::optional<std::size_t> find_channel(std::string_view name) const;
};

/// `picture` with the channels of `layers` appended. Both have the same size.
Image with_layers(const Image& picture, const Image& layers);

/// The channels of the layer `name` (see `Image`), in the order of the layer's components; nullopt if the image has no
/// such layer. A one-channel picture (Y or a single nameless channel) counts as the layer `color` with R = G = B.
std::optional<Image> select_layer(const Image& image, std::string_view name);

/// True for channels of radiance at a wavelength, as the layout for spectral OpenEXR images names them (Fichet,
/// Pacanowski & Wilkie 2021).
bool is_spectral_channel(std::string_view channel);

/// True for the channels that `with_noise` adds: the noise of other channels. Files store them as half floats.
bool is_noise_channel(std::string_view channel);

/// Distinct names of the layers of an image, in the order of its channels.
std::vector<std::string> layer_names(const Image& image);

}  // namespace lanthorn
