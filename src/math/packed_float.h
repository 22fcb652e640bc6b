// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Floats in few bits: half floats, and three floats with a shared exponent. Encoders round to nearest, ties to even.
#pragma once

#include <bit>
#include <cstdint>

#ifdef __F16C__
#include <immintrin.h>
#endif

#include "lanthorn/packed_float.h"
#include "math/vec.h"

namespace lanthorn {

/// `encode_half` by integer arithmetic, for processors without F16C instructions.
std::uint16_t encode_half_in_software(float x);
/// `decode_half` for processors without F16C instructions.
inline float decode_half_in_software(std::uint16_t h) {
  const std::uint32_t magnitude = h & 0x7fffu;
  // The exponent bias of a float is larger by 112. The product corrects it, and normalises denormals.
  const float value = std::bit_cast<float>(magnitude << 13) * 0x1p112f;
  const std::uint32_t not_finite = magnitude >= 0x7c00u ? 0x7f800000u : 0u;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) | not_finite | (h & 0x8000u) << 16);
}

/// A half float (IEEE 754 binary16). Values from 65520 on become infinite; NaN stays NaN.
inline std::uint16_t encode_half(float x) {
#ifdef __F16C__
  return _cvtss_sh(x, _MM_FROUND_TO_NEAREST_INT);
#else
  return encode_half_in_software(x);
#endif
}
inline float decode_half(std::uint16_t h) {
#ifdef __F16C__
  return _cvtsh_ss(h);
#else
  return decode_half_in_software(h);
#endif
}

/// Three non-negative floats as mantissas of 9 bits, red lowest, and a shared exponent of 5 bits (OpenGL's RGB9_E5).
/// Components above 65408 become 65408; negative ones and NaN become 0.
std::uint32_t encode_rgb9e5(float r, float g, float b);
inline Vec3 decode_rgb9e5(std::uint32_t code) {
  const float scale = std::bit_cast<float>((127u - 24u + (code >> 27)) << 23);  // 2^(exponent - 15 - 9)
  return scale * Vec3(static_cast<float>(code & 511u), static_cast<float>(code >> 9 & 511u),
                      static_cast<float>(code >> 18 & 511u));
}

}  // namespace lanthorn
