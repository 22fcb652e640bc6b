// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "spectrum/spectrum.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// The flux by which photons are compared, W: the sum over the components of the spectrum.
inline float flux_of(const Spectrum& power, bool dispersed, const Wavelengths& w) {
  return sum_of(dispersed ? power * w.dispersed : power);
}

/// Classes of photons by their flux.
///
/// Most photons of a pass carry about the same flux. Two kinds carry up to thousands of times as much: photons where an
/// emission guide has a very low density, and photons that were scattered by shading normals far from the geometric
/// ones (Veach 1997, eq. 5.19). In discs of one radius they would be bright spots. An estimate from photons of flux Φ
/// has variance ~ Φ/r² and bias ~ r². If the light of all classes is equally curved, the error is least for r⁶ ~ Φ;
/// discs of equal height, r² ~ Φ, suit light that is as dim as it is rare. The radii used lie between the two: r⁴ ~ Φ.
/// A photon of class c has 16^c times the flux of one of class 0 (within a factor of 4), and 2^c times the radius.
struct FluxClasses {
  static constexpr int most = 4;
  float reference = 0;  ///< flux of class 0 times the light paths of a pass, W; 0: all photons are of one class

  int count() const { return reference > 0 ? most : 1; }
  /// `flux`: of a photon, times the number of light paths of its pass, W.
  int of(float flux) const {
    if (!(reference > 0)) return 0;
    constexpr float large = 0x1p30f;  // bounds the exponent: an infinite flux has none
    const float ratio = std::min(flux / reference, large);
    return ratio > 1 ? std::min(most - 1, (std::ilogb(ratio) + 2) / 4) : 0;
  }
  /// Radius of a photon of this class, divided by the radius of class 0.
  static float radius_factor(int flux_class) { return static_cast<float>(1 << flux_class); }
  /// Squared radius of class 0, relative to the squared radius that serves all photons alike. `flux`: mean flux of
  /// these photons, as in `of`.
  float area_factor(float flux) const {
    return reference > 0 ? std::sqrt(reference / std::max(reference, flux)) : 1.0f;
  }
};

}  // namespace lanthorn
