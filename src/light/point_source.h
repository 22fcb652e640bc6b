// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "light/sample.h"

namespace lanthorn {

/// Sample of a light without extent and with intensity 1 W/sr; the caller multiplies its radiance by the light's
/// intensity. Nullopt if `from` coincides with the light or is too near for single precision.
inline std::optional<LightSample> see_point_source(const Point& position, const Point& from) {
  std::optional<LightSample> result;
  const Vec3 d = position - from;
  const float distance2 = length_squared(d);
  const float irradiance = 1 / distance2;
  if (!(irradiance < infinity)) return result;
  LightSample& sample = result.emplace();
  sample.distance = std::sqrt(distance2);
  sample.wi = d / sample.distance;
  sample.position = position;
  sample.radiance = Spectrum(irradiance);
  sample.pdf = 1;
  sample.delta = true;
  return result;
}

}  // namespace lanthorn
