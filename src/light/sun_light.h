// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/sample.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// A round light infinitely far away: the same radiance from all directions in a cone.
class SunLight {
 public:
  static constexpr LightTraits traits{.name = "sun", .has_surface = false, .is_infinite = true, .is_far = true};

  SunLight() = default;
  /// `towards`: from the scene to the light's centre. `half_angle`: of the cone, radians, in (0, π/2). `irradiance`:
  /// W/m² on a plane that faces the light.
  SunLight(const Direction& towards, double half_angle, const SpectrumCurve& irradiance, const BoundingSphere& scene);

  BoundingSphere scene;
  bool visible_to_camera = true;

  /// The cone's size on the unit sphere, steradians.
  float solid_angle() const;
  /// Half of the cone's angle, radians.
  float half_angle() const;

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  float pdf_direct(const Point& from, const Direction& towards) const;
  Spectrum emitted(const Point& from, const Direction& towards, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const;
  float largest_radiance(float far2) const;

 private:
  bool contains(const Direction& direction) const;

  Direction towards_{0, 0, 1};
  float one_minus_cos_ = 1;  ///< of the half angle: the cosine of a narrow cone cancels
  SpectrumCurve radiance_;   ///< W/(m² sr)
};

}  // namespace lanthorn
