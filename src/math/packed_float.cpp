// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/packed_float.h"

#include <algorithm>
#include <cmath>

namespace lanthorn {

std::uint16_t encode_half_in_software(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000u);
  const float magnitude = std::fabs(x);
  if (std::isnan(x)) return static_cast<std::uint16_t>(sign | 0x7e00u);
  if (magnitude >= 65520.0f) return static_cast<std::uint16_t>(sign | 0x7c00u);
  if (magnitude < 0x1p-14f) return static_cast<std::uint16_t>(sign | std::lrint(magnitude * 0x1p24f));
  // Round the mantissa to 10 bits, ties to even. A carry correctly increments the exponent.
  const std::uint32_t m = bits & 0x7fffffffu;
  const std::uint32_t rounded = m + 0xfffu + (m >> 13 & 1u);
  return static_cast<std::uint16_t>(sign | ((rounded >> 13) - (112u << 10)));
}

std::uint16_t encode_finite_half(float x) {
  return std::isnan(x) ? std::uint16_t{0} : encode_half(std::clamp(x, -largest_half, largest_half));
}

std::uint32_t encode_rgb9e5(float r, float g, float b) {
  const auto clamped = [](float x) { return x > 0 ? std::min(x, largest_rgb9e5) : 0.0f; };
  r = clamped(r), g = clamped(g), b = clamped(b);
  const float largest = std::max({r, g, b, 0x1p-16f});
  // Biased exponent for which the largest rounded mantissa is below 512.
  std::uint32_t exponent = (std::bit_cast<std::uint32_t>(largest) >> 23) - 127 + 16;
  const auto inverse_step = [](std::uint32_t e) { return std::bit_cast<float>((127u + 24u - e) << 23); };
  if (largest * inverse_step(exponent) >= 511.5f) ++exponent;
  const float scale = inverse_step(exponent);
  const auto mantissa = [scale](float x) { return static_cast<std::uint32_t>(std::lrint(x * scale)); };
  return mantissa(r) | mantissa(g) << 9 | mantissa(b) << 18 | exponent << 27;
}

}  // namespace lanthorn
