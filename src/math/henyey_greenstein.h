// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Henyey & Greenstein 1941: Diffuse radiation in the Galaxy.
#pragma once

#include <cmath>

#include "math/frame.h"
#include "math/sampling.h"
#include "math/vec.h"

namespace lanthorn {

/// Henyey & Greenstein's phase function, 1/sr, of a scattering angle with 1 - cosine = `versine` in [0,2]. The angle is
/// that between the directions of travel before and after scattering. `g` in (-1,1) is its mean cosine; positive:
/// forward scattering.
///
/// The denominator is 1 + g² - 2g cos = (1 - g)² + 2g (1 - cos): for |g| near 1 and small angles the left side cancels,
/// the right side does not. For g < 0 both signs change.
inline float henyey_greenstein(float g, float versine) {
  const float forward = std::fabs(g), from_peak = g < 0 ? 2 - versine : versine;
  const float d = sqr(1 - forward) + 2 * forward * from_peak;
  return 0.25f * inv_pi * (1 - forward) * (1 + forward) / (d * std::sqrt(d));
}

/// 1 - dot(a, b) of unit vectors, without cancellation at small angles.
inline float versine_between(const Direction& a, const Direction& b) { return 0.5f * distance_squared(a, b); }

/// The same for directions of travel before and after scattering.
inline float henyey_greenstein(float g, const Direction& in, const Direction& out) {
  // For g < 0 the peak is at the back: there the distance to the opposite direction is the small one.
  return g < 0 ? henyey_greenstein(-g, versine_between(-in, out)) : henyey_greenstein(g, versine_between(in, out));
}

struct SampledScattering {
  Direction out{0, 0, 1};  ///< direction of travel after scattering
  float pdf = 0;           ///< per steradian; equals the phase function
};

/// Samples the direction of travel after scattering from `in`, in proportion to the phase function. `u` in [0,1)².
///
/// The inverse of the distribution function is cos = (1 + g² - s²) / 2g with s = (1 - g²) / (1 + g - 2gu). Then
/// 1 - cos = (s - (1 - g)) (s + (1 - g)) / 2g, whose first factor is (1 - g) 2gu / (1 + g - 2gu): no difference of near
/// numbers and no division by g is left.
inline SampledScattering sample_henyey_greenstein(float g, const Direction& in, const Vec2& u) {
  const float forward = std::fabs(g), rest = 1 - forward;
  const float d = rest + 2 * forward * (1 - u.x);
  const float versine = std::fmin(2.0f, rest * u.x * (rest * (1 + forward) / d + rest) / d);
  const float sin = safe_sqrt(versine * (2 - versine)), phi = 2 * pi * u.y;
  const Direction peak = g < 0 ? -in : in;
  const Vec3 out = Frame(peak).to_world({sin * std::cos(phi), sin * std::sin(phi), 1 - versine});
  return {normalize(out), henyey_greenstein(forward, versine)};
}

}  // namespace lanthorn
