// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/brightness.h"
#include "light/sample.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Parallel light from infinitely far away.
struct DistantLight {
  static constexpr LightTraits traits{.name = "distant", .has_surface = false, .is_infinite = false, .is_far = true};

  Direction towards{0, 0, 1};  ///< from the scene to the light
  SpectrumCurve irradiance;    ///< W/m² on a plane that faces the light, scale included (pbrt's L)
  BoundingSphere scene;

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const;
  float largest_radiance(float far2) const;
};

}  // namespace lanthorn
