// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "spectrum/spectrum.h"

namespace lanthorn {

/// The colours of a light's image, row by row from the top. An 8-bit image stays bytes, which take a quarter of the
/// memory of floats.
class LightTexels {
 public:
  LightTexels() = default;
  LightTexels(std::vector<Rgb> colours) : colours_(std::move(colours)) {}
  /// `bytes`: the texels' channels, interleaved. `channels`: 1 to 4; the last of two or four, alpha, is ignored.
  /// `values`: the value of each byte, finite and >= 0.
  LightTexels(std::vector<std::uint8_t> bytes, std::size_t channels, const std::array<float, 256>& values)
      : bytes_(std::move(bytes)), channels_(channels), values_(values) {}

  std::size_t size() const { return channels_ == 0 ? colours_.size() : bytes_.size() / channels_; }
  Rgb operator[](std::size_t texel) const {
    if (channels_ == 0) return colours_[texel];
    const auto value = [&](std::size_t channel) { return values_[bytes_[texel * channels_ + channel]]; };
    return channels_ < 3 ? Rgb{value(0), value(0), value(0)} : Rgb{value(0), value(1), value(2)};
  }
  /// Replaces negative and non-finite values by 0.
  void clean() {
    const auto cleaned = [](float x) { return x > 0 && std::isfinite(x) ? x : 0.0f; };
    for (Rgb& c : colours_) c = {cleaned(c.r), cleaned(c.g), cleaned(c.b)};
  }

 private:
  std::vector<Rgb> colours_;
  std::vector<std::uint8_t> bytes_;  // instead of colours, if channels_ > 0
  std::size_t channels_ = 0;
  std::array<float, 256> values_{};
};

}  // namespace lanthorn
