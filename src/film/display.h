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

/// AgX (Sobotka 2022, "AgX", the script that makes its configuration), linear to display values, for finite components
/// >= 0. Colours are expressed in primaries moved a fifth of the way towards white: with w the share of each primary in
/// white's sum X + Y + Z, x' = 0.8 x + 0.2 w.x. Their logarithms, from 10 stops below middle grey (0.18) to 6.5 above
/// it, pass through a sigmoid with slope 2 at its middle; then the primaries are restored.
inline Rgb agx(const Rgb& linear) {
  constexpr float inset = 0.2f, darkest = -10, brightest = 6.5f, middle_grey = 0.18f;
  const auto white_part = [](const Rgb& c) { return 0.2120f * c.r + 0.3921f * c.g + 0.3959f * c.b; };
  // y = m + s t / (1 + t^p)^(1/p), t = 2 (x - x_m) / s, with s such that y is 0 at x = 0 and 1 at x = 1.
  const auto sigmoid = [](float x) {
    constexpr float slope = 2, pivot = -darkest / (brightest - darkest), middle = 0.5f;
    const float power = x < pivot ? 3.0f : 3.25f, end = slope * (x < pivot ? pivot : 1 - pivot);
    const float scale = std::pow((std::pow(end / middle, power) - 1) * std::pow(end, -power), -1 / power);
    const float t = slope * std::fabs(x - pivot) / scale;
    const float y = scale * t / std::pow(1 + std::pow(t, power), 1 / power);
    return x < pivot ? middle - y : middle + y;
  };
  const float white = inset * white_part(linear);
  const auto curve = [&](float x) {
    const float stops = std::log2(((1 - inset) * x + white) / middle_grey);
    return sigmoid(std::fmin(std::fmax((stops - darkest) / (brightest - darkest), 0.0f), 1.0f));
  };
  const Rgb inside{curve(linear.r), curve(linear.g), curve(linear.b)};
  const float white_inside = inset * white_part(inside);
  const auto outside = [&](float x) { return std::fmin(std::fmax((x - white_inside) / (1 - inset), 0.0f), 1.0f); };
  return {outside(inside.r), outside(inside.g), outside(inside.b)};
}

/// Linear colour to sRGB-encoded display values in [0,1]: exposure, curve, clamp, transfer. NaN becomes black, infinity
/// white.
inline Rgb to_display(const Rgb& linear, const DisplaySettings& display) {
  const float gain = std::exp2(display.exposure);
  if (display.curve == ToneCurve::agx) {
    const auto usable = [&](float x) { return x * gain > 0 ? std::fmin(x * gain, 1e4f) : 0.0f; };
    return agx({usable(linear.r), usable(linear.g), usable(linear.b)});
  }
  const auto encode = [&](float x) {
    x *= gain;
    if (!(x > 0)) return 0.0f;
    // Both curves reach 1 long before this limit; larger numbers would overflow in the filmic curve.
    x = std::fmin(x, 1e4f);
    if (display.curve == ToneCurve::filmic) x = filmic_curve(x);
    return srgb_from_linear(std::fmin(x, 1.0f));
  };
  return {encode(linear.r), encode(linear.g), encode(linear.b)};
}

}  // namespace lanthorn
