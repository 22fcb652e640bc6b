// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/file_access.h"
#include "lanthorn/scene_description.h"
#include "light/light_texels.h"
#include "math/vec.h"
#include "spectrum/rgb_matrix.h"
#include "spectrum/spectrum.h"
#include "texture/texel_reader.h"
#include "texture/texture_cache.h"
#include "texture/texture_format.h"

namespace lanthorn {

/// How texture coordinates outside the image are wrapped. octahedral_sphere applies to both axes.
struct WrapModes {
  description::Wrap s{}, t{};

  WrapModes() = default;
  WrapModes(description::Wrap both) : s(both), t(both) {}
  WrapModes(description::Wrap along_s, description::Wrap along_t) : s(along_s), t(along_t) {}
};

inline constexpr int alpha_channel = 3;

/// How an image is to be read.
struct ImageWish {
  TexelColours colours;
  bool levels = false;  ///< coarser ones, if the image is large
};

/// Images of at least this many texels have coarser levels where they are wanted: smaller ones fit into memory, and
/// mostly into the processor's caches, as they are.
inline constexpr std::size_t least_texels_with_levels = std::size_t{1} << 22;

/// Texels of an image file: 8-bit files stay bytes with a look-up table; all others become linear floats. Texels are in
/// memory or in tiles on disk, with the same values.
class TextureImage {
 public:
  /// Without texels: must not be looked up.
  TextureImage() = default;
  /// One texel of three channels, which replaces a missing file.
  explicit TextureImage(const Rgb& color);
  /// Reads the file into memory, subject to `access`. Throws Error with `location` on failure.
  TextureImage(const ImageSource& source, const FileAccess& access, const ImageWish& wish,
               const SourceLocation& location);
  /// The same, into tiles of `cache`.
  TextureImage(const ImageSource& source, const FileAccess& access, const ImageWish& wish,
               const SourceLocation& location, std::shared_ptr<TextureCache> cache);

  /// Space that an image takes, from the header of its file.
  struct Need {
    std::uint64_t memory = 0, disk = 0;  ///< bytes, if kept in memory, or in tiles
  };
  static Need need(const ImageSource& source, const FileAccess& access, const ImageWish& wish,
                   const SourceLocation& location);

  /// Samples at texture coordinates (s, t), t upwards: the nearest texel of a level, or bilinear interpolation of four.
  /// `colour` makes them a colour.
  Rgb rgb(const Vec2& st, const WrapModes& wrap, description::ImageFilter filter, int level = 0) const;
  /// Scalar value: `channel` (see description::ImageTexture) if given; else the value of a grey image, the alpha
  /// channel of a coloured one if it is not 1 everywhere, or the mean of three channels.
  float scalar(const Vec2& st, const WrapModes& wrap, description::ImageFilter filter,
               std::optional<int> channel = {}) const;

  /// Samples of one texel; row 0 is the top.
  Rgb texel(int x, int y) const;
  /// Linear Rec.709 of samples, whose primaries and white the file may state. Samples that are not colours, such as
  /// normals, stay as they are. Negative outside the gamut.
  Rgb colour(const Rgb& samples) const { return to_rec709_ && has_colour() ? *to_rec709_ * samples : samples; }

  /// Moves out the colours of all texels, which must be in memory.
  LightTexels take_colours() &&;

  int width() const { return format_.width; }
  int height() const { return format_.height; }
  int levels() const { return levels_; }
  bool has_colour() const { return channels_ >= 3; }
  bool has_alpha() const { return channels_ == 2 || channels_ == 4; }  ///< other than 1 somewhere
  bool is_cached() const { return cached_ != nullptr; }
  /// True for the typical colours of normal maps: means of red and green near .5, and blue above them.
  bool has_colours_of_normals() const;
  /// Bytes in memory.
  std::size_t bytes() const { return bytes_.size() + floats_.size() * sizeof(float); }

 private:
  struct Taps {
    std::array<TexelPlace, 4> place{};
    std::array<float, 4> weight{};  // 0 for texels outside with Wrap::black
  };
  /// A texel's stored samples.
  template <class Sample>
  struct Texel {
    const Sample* samples;
    const TextureImage& image;
    float operator[](int channel) const {
      if constexpr (std::is_same_v<Sample, float>)
        return samples[channel];
      else
        return image.format_.value_8_bit(samples[channel], channel);
    }
  };
  Taps taps(const Vec2& st, const WrapModes& wrap, description::ImageFilter filter, int level) const;
  // The sum over the taps of weight * value(texel).
  template <class Sum, class Value>
  Sum interpolated(const Taps& taps, int level, const Value& value) const;
  std::size_t index_of(const TexelPlace& place, int level) const {
    return level_begin(level) +
           static_cast<std::size_t>(place.row) * static_cast<std::size_t>(level_size(width(), level)) +
           static_cast<std::size_t>(place.column);
  }
  std::size_t level_begin(int level) const { return level == 0 ? 0 : level_begins_[static_cast<std::size_t>(level)]; }
  bool is_opaque() const;
  void drop_alpha();
  void make_levels();

  TextureFormat format_;
  int channels_ = 1;  // as in format_, but fewer than stored ones if a cached image is opaque
  int levels_ = 1;
  std::vector<std::size_t> level_begins_;  // texels
  std::vector<std::uint8_t> bytes_;
  std::vector<float> floats_;
  std::optional<RgbMatrix> to_rec709_;
  std::shared_ptr<TextureCache> cache_;
  const TextureCache::Image* cached_ = nullptr;
};

}  // namespace lanthorn
