// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "path/walk.h"

namespace lanthorn {

/// Flux with which a light path starts, W, times the number of light paths of the pass: the power of the lights, if all
/// paths carried as much. The sum of the spectrum's components.
inline float emitted_flux(const EmissionSample& emission, const LightPath& start, float paths) {
  return sum_of(emission.flux) * start.weight * paths;
}

/// Classes of photons by the flux with which they were emitted, each with radii of its own.
///
/// An emission guide sends many photons of little flux where it knows that they matter, and few of much flux elsewhere.
/// In discs of one radius the few would be bright spots. An estimate from photons of flux Φ has variance ~ Φ/r² and
/// bias ~ r², so that r⁶ ~ Φ has the least error if the light of all classes is equally curved; discs of equal height,
/// r² ~ Φ, suit light that is as dim as it is rare. The radii are between the two: r⁴ ~ Φ. A photon of class c has 4^c
/// times the flux of one of class 0 (within a factor of 2), and 2^(c/2) times the radius.
struct FluxClasses {
  static constexpr int most = 7;
  float reference = 0;  ///< `emitted_flux` of class 0, W; 0: all photons are of one class

  int count() const { return reference > 0 ? most : 1; }
  int of(float flux) const {
    if (!(reference > 0) || !(flux > reference)) return 0;
    return std::min(most - 1, (std::ilogb(flux / reference) + 1) / 2);
  }
  /// Radius of a photon of this class over that of class 0.
  static float radius_factor(int flux_class) { return std::exp2(0.5f * static_cast<float>(flux_class)); }
  /// Squared radius of class 0 over the one that would suit photons of this flux alone.
  float area_factor(float flux) const {
    return reference > 0 ? std::sqrt(reference / std::fmax(reference, flux)) : 1.0f;
  }
};

}  // namespace lanthorn
