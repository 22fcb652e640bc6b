// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/sample.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// A point that emits the same intensity in all directions.
struct PointLight {
  Point position{0};
  SpectrumCurve intensity;  ///< W/sr, scale included

  std::optional<LightSample> sample_direct(const Point& from, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_direction, const Wavelengths& w) const;
  EmissionPdf pdf_emission() const;
  float power() const;
};

}  // namespace lanthorn
