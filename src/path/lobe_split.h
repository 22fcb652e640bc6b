// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How the light that a closure scatters is divided between a cache of light, such as photons, and the walk.
#pragma once

#include "math/vec.h"
#include "path/coherence.h"

namespace lanthorn {

/// Division of a vertex's light by direction. The denser the closure samples a direction, the fewer photons meet the
/// lobe there, each with a large f, and the surer the walk finds its light. So narrow lobes are the walk's also where
/// they lie on wide ones, as on varnish.
///
/// With p the density of sampling the direction (1/sr) and e the part of it above that of a diffuse surface, the walk
/// has e / (e + h) of the light from there and the cache h / (e + h). So f |cos| of what the cache counts stays below
/// h.
class LobeSplit {
 public:
  constexpr LobeSplit() = default;
  /// The cache has all light: for closures no narrower than diffuse ones.
  static constexpr LobeSplit all_wide() { return {infinity, 1}; }
  /// The walk has all light.
  static constexpr LobeSplit all_narrow() { return {-1, 0}; }

  /// The parts of walk and cache; they sum to 1. `pdf`: of the closure, per solid angle; infinite for delta lobes.
  float narrow(float pdf) const { return 1 - wide(pdf); }
  float wide(float pdf) const { return pdf > least_ ? half_ / (half_ + pdf - least_) : 1.0f; }

  bool is_all_wide() const { return least_ == infinity; }
  bool is_all_narrow() const { return half_ == 0; }

 private:
  constexpr LobeSplit(float least, float half) : least_(least), half_(half) {}

  float least_ = inv_pi;  // no part of smaller densities is the walk's
  // The excess at which both have half. Each has about half of the light of a GGX lobe of width half_spread_alpha, seen
  // at right angles: its density is p0 / (1 + u)^2 with p0 = 1 / (4 pi alpha^2) and u = tan^2 / alpha^2, and the
  // integral of h / (h + p) over the lobe is x atan(1 / x) with x^2 = h / p0.
  float half_ = 0.184f * 0.25f * inv_pi / sqr(half_spread_alpha);
};

}  // namespace lanthorn
