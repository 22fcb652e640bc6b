// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Texels as texture files hold them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/bytes.h"
#include "lanthorn/ibl.h"
#include "lanthorn/image.h"

namespace lanthorn {

/// The nearest half-float, ties to even; beyond the range the largest. NaN is 0.
inline std::uint16_t half_from_float(float x) {
  if (std::isnan(x)) return 0;
  const float magnitude = std::fmin(std::fabs(x), largest_half);
  const auto sign = static_cast<std::uint16_t>(std::signbit(x) ? 0x8000 : 0);
  int exponent = 0;
  std::frexp(magnitude, &exponent);
  // Below 2^-14 steps are those of the smallest normal numbers.
  const int step = std::max(exponent, -13) - 11;
  const auto steps = static_cast<int>(std::nearbyint(std::ldexp(magnitude, -step)));
  // Rounding up to the next power of two carries into the exponent, as it should.
  const int biased = steps < 1024 ? 0 : step + 25 - 1;
  return static_cast<std::uint16_t>(sign | ((biased << 10) + steps));
}

/// Three colours with one exponent (the OpenGL extension EXT_texture_shared_exponent).
inline std::uint32_t rgb9e5_from_floats(const std::array<float, 3>& rgb) {
  const auto clamp = [](float x) { return x > 0 ? std::fmin(x, largest_rgb9e5) : 0.0f; };
  const float r = clamp(rgb[0]), g = clamp(rgb[1]), b = clamp(rgb[2]), largest = std::max({r, g, b});
  constexpr int bias = 15, mantissa_bits = 9;
  int exponent = 0;
  std::frexp(largest, &exponent);
  int shared = largest > 0 ? std::max(exponent + bias, 0) : 0;
  const auto steps = [&](float x) {
    return static_cast<std::uint32_t>(std::floor(std::ldexp(x, bias + mantissa_bits - shared) + 0.5f));
  };
  if (steps(largest) == 1u << mantissa_bits) ++shared;
  return steps(r) | steps(g) << 9 | steps(b) << 18 | static_cast<std::uint32_t>(shared) << 27;
}

/// The texels of a rectangle of channels R, G, B; half floats have an alpha of 1.
inline void append_texels(std::string& out, const Image& image, int left, int width, TexelFormat format) {
  for (int y = 0; y < image.height; ++y)
    for (int x = left; x < left + width; ++x) {
      const float* const p = image.pixels.data() + image.index(x, y);
      if (format == TexelFormat::rgb9e5) {
        append_number(out, rgb9e5_from_floats({p[0], p[1], p[2]}));
        continue;
      }
      for (int c = 0; c < 3; ++c) append_number(out, half_from_float(p[c]));
      append_number(out, half_from_float(1));
    }
}

inline std::uint32_t bytes_per_texel(TexelFormat format) { return format == TexelFormat::half ? 8 : 4; }

}  // namespace lanthorn
