// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Division of the light that a closure scatters between a cache of light, such as photons, and the walk.
#pragma once

#include "math/vec.h"
#include "path/coherence.h"

namespace lanthorn {

/// Division of a vertex's light by direction. The more densely the closure samples a direction, the fewer photons meet
/// the lobe there, each with a large f, and the more reliably the walk finds the light. Narrow lobes are therefore left
/// to the walk even where they lie on wide ones, as on varnish.
///
/// Let p be the density with which the closure samples a direction (1/sr) and e = max(0, p - 1/π) its excess over a
/// diffuse surface. The walk takes e / (e + h) of the light from that direction and the cache h / (e + h), so that f
/// |cos| of the light that the cache counts stays below h.
class LobeSplit {
 public:
  constexpr LobeSplit() = default;
  /// The cache takes all light: for closures no narrower than diffuse ones.
  static constexpr LobeSplit all_wide() { return {infinity, 1}; }
  /// The walk takes all light.
  static constexpr LobeSplit all_narrow() { return {-1, 0}; }

  /// The parts of walk and cache; they sum to 1. `pdf`: of the closure, per solid angle; infinite for delta lobes.
  float narrow(float pdf) const { return 1 - wide(pdf); }
  float wide(float pdf) const { return pdf > least_ ? half_ / (half_ + pdf - least_) : 1.0f; }

  bool is_all_wide() const { return least_ == infinity; }
  bool is_all_narrow() const { return half_ == 0; }

 private:
  constexpr LobeSplit(float least, float half) : least_(least), half_(half) {}

  float least_ = inv_pi;  // up to this density the cache takes all light
  // The excess h at which both take half. Each then takes about half of the light of a GGX lobe of width
  // half_spread_alpha at normal incidence: the lobe's density is p0 / (1 + u)^2 with p0 = 1 / (4 pi alpha^2) and u =
  // tan^2 / alpha^2, and the integral of h / (h + p) over the lobe is x atan(1 / x) with x^2 = h / p0.
  float half_ = 0.184f * 0.25f * inv_pi / sqr(half_spread_alpha);
};

}  // namespace lanthorn
