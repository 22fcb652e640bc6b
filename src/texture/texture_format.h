// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How the texels of an image are stored, in memory or in tiles on disk, and the coarser levels made of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "image/image_codec.h"

namespace lanthorn {

/// Texels as they are stored: 8-bit samples with a table of their linear values, or linear floats. The last of two or
/// four channels is alpha, which 8-bit samples hold in 255ths.
struct TextureFormat {
  int width = 0, height = 0;
  int channels = 1;  ///< stored: grey, grey and alpha, RGB, or RGB and alpha
  bool is_8_bit = false;
  std::array<float, 256> decode{};  ///< of 8-bit samples

  std::size_t texel_bytes() const { return static_cast<std::size_t>(channels) * (is_8_bit ? 1 : sizeof(float)); }
  std::size_t row_bytes() const { return texel_bytes() * static_cast<std::size_t>(width); }
  bool has_alpha() const { return channels == 2 || channels == 4; }
  bool is_alpha(int channel) const { return has_alpha() && channel == channels - 1; }
  float value_8_bit(std::uint8_t sample, int channel) const {
    return is_alpha(channel) ? static_cast<float>(sample) / 255.0f : decode[sample];
  }
};

/// Number of levels down to a single texel. 1 if the table of 8-bit samples does not ascend: means then cannot be
/// stored.
int all_levels_of(const TextureFormat& format);
/// Number of texels of the first `levels` levels together.
std::size_t texels_of_levels(int width, int height, int levels);

/// Makes the levels of an image whose rows arrive from the top. A texel is the mean of the four texels below it, of
/// fewer at the right and lower edges. 8-bit samples are rounded at random, so that linear values keep their mean; the
/// random numbers are functions of level, row, column and channel.
class LevelMaker {
 public:
  /// Called for each row of each level, from the top.
  using TakeRow = std::function<void(int level, int y, const std::byte* row)>;

  LevelMaker(const TextureFormat& format, int levels, TakeRow take);
  /// The next row of the image.
  void add(const std::byte* row) { add(0, row); }

 private:
  struct Level {
    int width = 0, height = 0;
    int rows = 0;                  // so far
    std::vector<std::byte> upper;  // the last row of even number
    std::vector<std::byte> coarser;
  };
  void add(std::size_t level, const std::byte* row);
  void halve(std::size_t level, const std::byte* upper, const std::byte* lower);
  std::uint8_t encoded(float value, int channel, float u) const;

  TextureFormat format_;
  std::vector<Level> levels_;
  TakeRow take_;
  std::vector<std::uint8_t> first_guess_;  // of the sample of a linear value
};

}  // namespace lanthorn
