// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "light/brightness.h"
#include "light/profile.h"
#include "math/frame.h"
#include "math/sampling.h"
#include "spectrum/curve.h"

namespace lanthorn {

/// A disk in the sky: the same radiance from all directions in a cone.
class ConeProfile {
 public:
  static constexpr const char* of_far = "sun";

  ConeProfile() = default;
  /// `axis`: towards the light's centre. `half_angle`: of the cone, radians, in (0, π/2). `irradiance`: W/m² on a plane
  /// that faces the light: π sin² of the half angle times the radiance.
  ConeProfile(const Direction& axis, double half_angle, const SpectrumCurve& irradiance)
      : axis_(axis),
        one_minus_cos_(static_cast<float>(2 * sqr(std::sin(half_angle / 2)))),
        radiance_(irradiance.scaled(static_cast<float>(1 / (std::numbers::pi * sqr(std::sin(half_angle)))))) {}

  /// Half of the cone's angle, radians.
  float half_angle() const { return 2 * std::asin(std::sqrt(one_minus_cos_ / 2)); }

  Spectrum value(const Direction& d, const Wavelengths& w) const {
    return contains(d) ? radiance_.evaluate(w) : Spectrum();
  }
  std::optional<ProfileSample> sample(const Vec2& u, const Wavelengths& w) const {
    return ProfileSample{Frame(axis_).to_world(sample_uniform_cone(u, one_minus_cos_)), radiance_.evaluate(w),
                         pdf_uniform_cone(one_minus_cos_)};
  }
  float pdf(const Direction& d) const { return contains(d) ? pdf_uniform_cone(one_minus_cos_) : 0.0f; }
  std::optional<Vec2> invert(const Direction& d) const {
    return invert_uniform_cone(Frame(axis_).to_local(d), one_minus_cos_);
  }
  float integral() const { return luminance(radiance_.rgb) * 2 * pi * one_minus_cos_; }
  float largest() const { return largest_value(radiance_); }

 private:
  // By the distance of unit vectors, |a - b|² = 2 (1 - cos).
  bool contains(const Direction& d) const { return length_squared(d - axis_) <= 2 * one_minus_cos_; }

  Direction axis_{0, 0, 1};
  float one_minus_cos_ = 1;  ///< of the half angle: the cosine of a narrow cone cancels
  SpectrumCurve radiance_;   ///< W/(m² sr)
};

}  // namespace lanthorn
