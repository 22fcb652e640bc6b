// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lanthorn/scene_description.h"
#include "light/profile.h"
#include "spectrum/curve.h"

namespace lanthorn {

/// A cone of light: full intensity up to the start angle of the falloff, none beyond the total angle, and a function of
/// the cosine in between. Angles are stored as 1 - cos, which does not cancel for narrow cones.
struct SpotProfile {
  using Falloff = description::SpotFalloff;

  static constexpr const char* of_point = "spot";

  Direction axis{0, 0, 1};
  SpectrumCurve intensity;        ///< W/sr on the axis, scale included
  float one_minus_cos_start = 0;  ///< of the angle at which the falloff starts
  float one_minus_cos_total = 1;  ///< of the angle beyond which no light is emitted
  Falloff shape = Falloff::smoothstep;

  SpotProfile() = default;
  /// Angles in radians from the axis, 0 <= start <= total <= pi.
  SpotProfile(const Direction& axis, const SpectrumCurve& intensity, float start_angle, float total_angle,
              Falloff shape = Falloff::smoothstep);

  /// Intensity in `direction` (away from the light) as a fraction of that on the axis.
  float falloff(const Direction& direction) const;
  /// Integral of the falloff over all directions, sr: intensity = power / this.
  float solid_angle() const;

  Spectrum value(const Direction& d, const Wavelengths& w) const { return intensity.evaluate(w) * falloff(d); }
  std::optional<ProfileSample> sample(const Vec2& u, const Wavelengths& w) const;
  float pdf(const Direction& d) const { return falloff(d) / solid_angle(); }
  std::optional<Vec2> invert(const Direction& d) const;
  float integral() const;
  float largest() const;
  ProfileBounds bounds() const;
};

}  // namespace lanthorn
