// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Phase functions.
#pragma once

#include "math/henyey_greenstein.h"
#include "math/vec.h"

namespace lanthorn {

/// Henyey & Greenstein's phase function. g in (-1,1) is the mean cosine between the directions of travel before and
/// after scattering; positive: forward scattering.
struct HenyeyGreenstein {
  float g = 0;
};

struct PhaseSample {
  Direction wo{0, 0, 1};
  float pdf = 0;  ///< per steradian; equals the phase function, so the sample's weight is 1
};

/// Phase function, 1/sr, normalised over the sphere of `wo`. Both directions point away from the scattering point.
inline float phase(const HenyeyGreenstein& hg, const Direction& wi, const Direction& wo) {
  return henyey_greenstein(hg.g, -wi, wo);
}

/// Samples wo in proportion to the phase function. `u` uniform in [0,1)².
inline PhaseSample sample_phase(const HenyeyGreenstein& hg, const Direction& wi, const Vec2& u) {
  const SampledScattering s = sample_henyey_greenstein(hg.g, -wi, u);
  return {s.out, s.pdf};
}

}  // namespace lanthorn
