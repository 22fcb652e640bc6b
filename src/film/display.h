// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// From linear colours to display values.
#pragma once

#include <algorithm>
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

/// The curve of ToneCurve::highlights: y = x up to the knee k = 0.7, and y = k + log(1 + a (x - k)) / a above it, which
/// has slope 1 at the knee. The strength a is such that `white` becomes 1: a (1 - k) = log(1 + a (white - k)).
class HighlightCurve {
 public:
  static constexpr float knee = 0.7f;

  explicit HighlightCurve(float white) {
    constexpr double most = 65536, least = 1.0001, strongest = 100;
    const double span = std::min(static_cast<double>(white), most) - static_cast<double>(knee), left = 1 - knee;
    if (!(white > least)) return;
    // The difference of both sides is convex: Newton's method descends from the right to the positive root.
    double a = strongest;
    for (int i = 0; i < 64; ++i) a -= (left * a - std::log1p(a * span)) / (left - span / (1 + a * span));
    strength_ = static_cast<float>(a);
  }
  float operator()(float x) const {
    return x > knee && strength_ > 0 ? knee + std::log1p(strength_ * (x - knee)) / strength_ : x;
  }
  /// 0: the curve is y = x.
  float strength() const { return strength_; }

 private:
  float strength_ = 0;
};

/// Linear colours to sRGB-encoded display values in [0,1]: exposure, curve, clamp, transfer. NaN becomes black,
/// infinity white. With ToneCurve::highlights, a missing `brightest` counts as white.
class DisplayTransform {
 public:
  explicit DisplayTransform(const DisplaySettings& display)
      : curve_(display.curve),
        gain_(std::exp2(display.exposure)),
        highlights_(display.curve == ToneCurve::highlights ? display.brightest.value_or(0) * gain_ : 0) {}

  Rgb operator()(const Rgb& linear) const {
    if (curve_ == ToneCurve::agx) return agx({usable(linear.r), usable(linear.g), usable(linear.b)});
    return {encode(linear.r), encode(linear.g), encode(linear.b)};
  }

 private:
  // All curves reach 1 before this limit; larger numbers would overflow in the filmic curve.
  float usable(float x) const { return x * gain_ > 0 ? std::fmin(x * gain_, 65536.0f) : 0.0f; }
  float encode(float x) const {
    x = usable(x);
    if (curve_ == ToneCurve::filmic) x = filmic_curve(x);
    return srgb_from_linear(std::fmin(highlights_(x), 1.0f));
  }

  ToneCurve curve_;
  float gain_;
  HighlightCurve highlights_;
};

inline Rgb to_display(const Rgb& linear, const DisplaySettings& display) { return DisplayTransform(display)(linear); }

}  // namespace lanthorn
