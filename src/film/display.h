// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// From linear colours to display values.
#pragma once

#include <cmath>

#include "lanthorn/image_file.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// sRGB's transfer function (IEC 61966-2-1), for x in [0,1].
inline float srgb_from_linear(float x) {
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}
/// Inverse of `srgb_from_linear`.
inline float linear_from_srgb(float x) { return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f); }

/// Narkowicz (2015), "ACES filmic tone mapping curve": [0, inf) to [0, 1.03]; not clamped. x >= 0 and finite.
inline float filmic_curve(float x) { return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f); }

/// A linear component to a linear display value in [0,1]: exposure, curve, clamp. NaN becomes black, infinity white.
inline float exposed(float x, const DisplaySettings& display) {
  x *= std::exp2(display.exposure);
  if (!(x > 0)) return 0.0f;
  // Both curves have reached 1 long before this limit; larger numbers would overflow in the filmic curve.
  x = std::fmin(x, 1e4f);
  if (display.curve == ToneCurve::filmic) x = filmic_curve(x);
  return std::fmin(x, 1.0f);
}

/// Linear colour to sRGB-encoded display values in [0,1].
inline Rgb to_display(const Rgb& linear, const DisplaySettings& display) {
  const auto encode = [&](float x) { return srgb_from_linear(exposed(x, display)); };
  return {encode(linear.r), encode(linear.g), encode(linear.b)};
}
/// The same where `emission`, a part of the colour, is meant for the display: neither exposure nor curve applies to it.
inline Rgb to_display(const Rgb& linear, const Rgb& emission, const DisplaySettings& display) {
  const auto encode = [&](float all, float shown) {
    return srgb_from_linear(std::fmin(exposed(all - shown, display) + std::fmax(shown, 0.0f), 1.0f));
  };
  return {encode(linear.r, emission.r), encode(linear.g, emission.g), encode(linear.b, emission.b)};
}

}  // namespace lanthorn
