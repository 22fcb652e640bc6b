// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/file_access.h"
#include "lanthorn/scene_description.h"
#include "light/light_texels.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Location of an image file's bytes: on disk, or embedded in the scene file. Refers to its argument.
class ImageSource {
 public:
  ImageSource(const std::string& filename) : name_(&filename) {}
  ImageSource(const description::EmbeddedImage& image) : name_(&image.name), bytes_(&image.bytes) {}

  const std::string& name() const { return *name_; }
  /// Null for a file on disk.
  const std::string* bytes() const { return bytes_; }

 private:
  const std::string* name_;
  const std::string* bytes_ = nullptr;
};

/// How texture coordinates beyond the image are taken back into it. octahedral_sphere concerns both axes.
struct WrapModes {
  description::Wrap s{}, t{};

  WrapModes() = default;
  WrapModes(description::Wrap both) : s(both), t(both) {}
  WrapModes(description::Wrap along_s, description::Wrap along_t) : s(along_s), t(along_t) {}
};

inline constexpr int alpha_channel = 3;

/// Texels of an image file, decoded once: 8-bit files stay bytes with a look-up table; all others become linear floats.
class TextureImage {
 public:
  /// Without texels: must not be looked up.
  TextureImage() = default;
  /// One texel of three channels, in place of a file that is missing.
  explicit TextureImage(const Rgb& color) : width_(1), height_(1), channels_(3), floats_{color.r, color.g, color.b} {}
  /// Reads the file, subject to `access`. Throws Error with `location` on failure.
  TextureImage(const ImageSource& source, const FileAccess& access, description::Encoding encoding, float gamma,
               ColorSpace space, const SourceLocation& location);

  /// Value at texture coordinates (s, t), t upwards: the nearest texel, or bilinear interpolation of four.
  Rgb rgb(const Vec2& st, const WrapModes& wrap, description::ImageFilter filter) const;
  /// Scalar value: `channel` (see description::ImageTexture) if given; else the only channel, the alpha channel if it
  /// is not 1 everywhere, or the mean of three channels.
  float scalar(const Vec2& st, const WrapModes& wrap, description::ImageFilter filter,
               std::optional<int> channel = {}) const;

  /// Colour of one texel; row 0 is the top.
  Rgb texel(int x, int y) const;

  /// The colours of all texels. Nothing is left.
  LightTexels take_colours() &&;

  int width() const { return width_; }
  int height() const { return height_; }
  bool has_colour() const { return channels_ >= 3; }
  bool has_alpha() const { return channels_ == 4; }  ///< other than 1 somewhere
  /// True for colours as normal maps have them: red and green about .5 in the mean, blue above them.
  bool has_colours_of_normals() const;
  std::size_t bytes() const { return bytes_.size() + floats_.size() * sizeof(float); }

 private:
  struct Taps {
    std::array<std::size_t, 4> texel{};
    std::array<float, 4> weight{};  // 0 for texels outside with Wrap::black
  };
  Taps taps(const Vec2& st, const WrapModes& wrap, description::ImageFilter filter) const;
  float value(std::size_t texel, int channel) const {
    const std::size_t i = texel * static_cast<std::size_t>(channels_) + static_cast<std::size_t>(channel);
    if (!floats_.empty()) return floats_[i];
    return channel == 3 ? static_cast<float>(bytes_[i]) / 255.0f : decode_[bytes_[i]];
  }
  Rgb colour(std::size_t texel) const;
  float scalar(std::size_t texel, std::optional<int> channel) const;
  void drop_opaque_alpha();
  void convert_from(ColorSpace space);

  int width_ = 0, height_ = 0, channels_ = 1;  // 1, 3 or 4
  std::array<float, 256> decode_{};
  std::vector<std::uint8_t> bytes_;
  std::vector<float> floats_;
};

}  // namespace lanthorn
