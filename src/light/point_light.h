// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/brightness.h"
#include "light/sample.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// A point that emits the same intensity in all directions.
struct PointLight {
  static constexpr LightTraits traits{.name = "point", .has_surface = false, .is_infinite = false, .is_far = false};

  Point position{0};
  SpectrumCurve intensity;  ///< W/sr, scale included

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
