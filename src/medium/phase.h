// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Phase functions.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/frame.h"
#include "math/vec.h"

namespace lanthorn {

/// Henyey & Greenstein's (1941) phase function. g in (-1,1) is the mean cosine between the directions of travel before
/// and after scattering; positive: forward scattering.
struct HenyeyGreenstein {
  float g = 0;
};

struct PhaseSample {
  Direction wo{0, 0, 1};
  float pdf = 0;  ///< per steradian; equals the phase function, so the sample's weight is 1
};

/// Phase function, 1/sr, normalised over the sphere of `wo`. Both directions point away from the scattering point.
inline float phase(const HenyeyGreenstein& hg, const Direction& wi, const Direction& wo) {
  const float g = hg.g;
  const float d = 1 + g * g + 2 * g * dot(wi, wo);
  return (1 - g * g) / (4 * pi * d * std::sqrt(d));
}

/// Samples wo in proportion to the phase function. `u` uniform in [0,1)².
inline PhaseSample sample_phase(const HenyeyGreenstein& hg, const Direction& wi, const Vec2& u) {
  const float g = hg.g;
  float cos = 1 - 2 * u.x;  // cosine to the direction of travel, -wi
  if (std::fabs(g) > 1e-3f) {
    const float s = (1 - g * g) / (1 + g - 2 * g * u.x);
    cos = (1 + g * g - s * s) / (2 * g);
  }
  cos = std::min(1.0f, std::max(-1.0f, cos));
  const float sin = safe_sqrt(1 - cos * cos), phi = 2 * pi * u.y;
  const Direction wo = normalize(Frame(-wi).to_world({sin * std::cos(phi), sin * std::sin(phi), cos}));
  return {wo, phase(hg, wi, wo)};
}

}  // namespace lanthorn
