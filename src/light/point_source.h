// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "light/sample.h"

namespace lanthorn {

/// A light without extent as seen from a point: the complete sample except its radiance, which is intensity /
/// distance2.
struct PointSource {
  LightSample sample;
  float distance2 = 0;  ///< m²
};

/// Returns nullopt if `from` coincides with the light.
inline std::optional<PointSource> see_point_source(const Point& position, const Point& from) {
  const Vec3 d = position - from;
  const float distance2 = length_squared(d);
  if (!(distance2 > 0)) return {};
  PointSource source{{}, distance2};
  LightSample& sample = source.sample;
  sample.distance = std::sqrt(distance2);
  sample.wi = d / sample.distance;
  sample.position = position;
  sample.pdf = 1;
  sample.delta = true;
  return source;
}

}  // namespace lanthorn
