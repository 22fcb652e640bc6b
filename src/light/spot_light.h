// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lanthorn/scene_description.h"
#include "light/brightness.h"
#include "light/sample.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// A point light that emits into a cone: full intensity up to the start angle of the falloff, none beyond the total
/// angle, and a function of the cosine in between. Angles are stored as 1 - cos, which does not cancel for narrow
/// cones.
struct SpotLight {
  using Falloff = description::SpotFalloff;

  static constexpr LightTraits traits{.name = "spot", .has_surface = false, .is_infinite = false, .is_far = false};

  Point position{0};
  Direction axis{0, 0, 1};
  SpectrumCurve intensity;        ///< W/sr on the axis, scale included
  float one_minus_cos_start = 0;  ///< of the angle at which the falloff starts
  float one_minus_cos_total = 1;  ///< of the angle beyond which no light is emitted
  Falloff shape = Falloff::smoothstep;

  SpotLight() = default;
  /// Angles in radians from the axis, 0 <= start <= total <= pi.
  SpotLight(const Point& position, const Direction& axis, const SpectrumCurve& intensity, float start_angle,
            float total_angle, Falloff shape = Falloff::smoothstep);

  /// Intensity in `direction` (away from the light) as a fraction of that on the axis.
  float falloff(const Direction& direction) const;
  /// Integral of the falloff over all directions, sr: intensity = power / this.
  float solid_angle() const;

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const;
  float largest_radiance(float far2) const;
  EmissionBounds bounds() const;
};

}  // namespace lanthorn
