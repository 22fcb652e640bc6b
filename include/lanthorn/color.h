// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Colours, and the wavelengths that carry them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lanthorn {

/// Linear colour in Rec.709 primaries (no gamma). Components may be slightly negative outside the gamut.
struct Rgb {
  float r = 0, g = 0, b = 0;

  Rgb& operator+=(const Rgb& o) { return r += o.r, g += o.g, b += o.b, *this; }
  friend Rgb operator+(Rgb x, const Rgb& y) { return x += y; }
  friend Rgb operator*(float s, const Rgb& a) { return {s * a.r, s * a.g, s * a.b}; }
  friend Rgb operator*(const Rgb& x, const Rgb& y) { return {x.r * y.r, x.g * y.g, x.b * y.b}; }
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Primaries and white point of the RGB values in a scene file.
enum class ColorSpace : std::uint8_t { srgb, dci_p3, rec2020, aces2065_1 };

/// The quantity that a path carries: RGB, or radiance at a few randomly sampled wavelengths.
enum class ColorMode : std::uint8_t { rgb, spectral };
/// The names of the modes, in the order of `ColorMode`, as in options, plain data and files.
inline constexpr std::array<std::string_view, 2> color_mode_names{"rgb", "spectral"};

inline constexpr float lambda_min = 360;  ///< nm
inline constexpr float lambda_max = 830;  ///< nm

/// Divides a range of wavelengths into `count` equal intervals.
struct SpectralBuckets {
  std::size_t count = 16;
  float low = lambda_min, high = lambda_max;  ///< nm

  float width() const { return (high - low) / static_cast<float>(count); }
  double centre(std::size_t bucket) const {
    const double share = (static_cast<double>(bucket) + 0.5) / static_cast<double>(count);
    return static_cast<double>(low) + share * (static_cast<double>(high) - static_cast<double>(low));
  }
  /// Index of the interval that contains a wavelength (in nm); nullopt outside the range.
  std::optional<std::size_t> find(float nm) const {
    if (!(nm >= low && nm <= high)) return std::nullopt;
    return std::min(static_cast<std::size_t>((nm - low) / width()), count - 1);
  }
  friend bool operator==(const SpectralBuckets&, const SpectralBuckets&) = default;
};

}  // namespace lanthorn
