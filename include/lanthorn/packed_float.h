// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lanthorn {

/// The largest finite values of half floats (IEEE 754 binary16) and of floats with a shared exponent (RGB9_E5).
inline constexpr float largest_half = 65504, largest_rgb9e5 = 65408;

/// The nearest finite half float, ties to even: larger magnitudes become ±65504, NaN becomes 0.
std::uint16_t encode_finite_half(float x);

}  // namespace lanthorn
