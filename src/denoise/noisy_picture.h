// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A rendered picture as input of the denoiser: tile by tile, split into halves of the passes.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "denoise/layer.h"
#include "lanthorn/image.h"

namespace lanthorn::denoising {

inline constexpr std::array<const char*, 3> components{"R", "G", "B"};

/// Three channels on which light is regressed.
struct FeatureLayer {
  const char* name;
  std::array<const char*, 3> components;
};
/// The albedo must be the first.
inline constexpr std::array<FeatureLayer, 3> feature_layers{FeatureLayer{"albedo", {"R", "G", "B"}},
                                                            FeatureLayer{"normal", {"X", "Y", "Z"}},
                                                            FeatureLayer{"position", {"X", "Y", "Z"}}};

bool has_layer(const Image& picture, const std::string& layer, const std::array<const char*, 3>& names);
/// The light layers whose halves are known.
std::vector<std::string> light_layers(const Image& picture);
/// True if all layers exist that `NoisyPicture` reads.
bool has_halves(const Image& picture);
/// True if other layers already contain this layer's light.
bool is_repeated(const std::string& layer);

/// The pixels that are written, and the larger region from which they are denoised.
struct Tile {
  int x, y, width, height;
  int outer_x, outer_y, outer_width, outer_height;
};
/// A rectangle of pixels of a picture.
struct Part {
  int x = 0, y = 0, width = 0, height = 0;
};
/// Tiles that cover a part of a picture of this size.
std::vector<Tile> tiles_of(const Part& part, int width, int height);

/// Access to the picture's channels; non-finite pixels are read as black.
class NoisyPicture {
 public:
  /// `picture` must have halves and outlive this object. Throws Error if a half has no passes, or if layers are
  /// missing.
  explicit NoisyPicture(const Image& picture);

  const Image& image() const { return picture_; }
  std::size_t pixel_count() const { return picture_.pixels.size() / picture_.channel_count(); }
  const Shares& shares() const { return shares_; }
  double fewest_passes() const { return fewest_passes_; }  ///< of the smaller half

  /// A channel of the tile including its margin.
  Plane read(const Tile& tile, const std::string& name) const;
  Halves read_halves(const Tile& tile, const std::string& layer, const std::array<const char*, 3>& names) const;
  static constexpr int scale_radius = 2;  ///< of the squares over which `scale_of` averages light
  float least_scale() const;              ///< of black pixels
  /// As in `ErrorEstimate`; values above ten times the picture's mean are clamped to it.
  ErrorScale scale_of(const Tile& tile) const;
  /// Factors that divide light by the albedo of these features.
  ColorPlanes demodulation_of(const std::array<FeaturePlanes, 2>& features) const;

 private:
  std::size_t channel_of(const std::string& name) const { return *picture_.find_channel(name); }
  // Checks that the layers add up, because other programs may have omitted some. `light`: sum of color over all pixels.
  void check_sum(double light) const;

  const Image& picture_;
  Shares shares_{};
  double fewest_passes_ = 0;
  float mean_ = 0;
};

}  // namespace lanthorn::denoising
