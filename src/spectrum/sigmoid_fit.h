// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "spectrum/cie.h"

namespace lanthorn {

/// Coefficients a of the reflectance sigmoid(a[0] t^2 + a[1] t + a[2]), t = (lambda - 360 nm) / 470 nm.
using UnitSigmoid = std::array<double, 3>;

/// Fits smooth reflectances that have a given colour under a colour space's own illuminant: Jakob & Hanika 2019, "A
/// low-dimensional function space for efficient spectral upsampling", section 3.
class SigmoidFit {
 public:
  explicit SigmoidFit(ColorSpace space);

  /// Minimises the CIELAB distance to a linear RGB colour in [0,1]^3 of the space by damped Gauss-Newton steps from
  /// `start`. A colour that no reflectance of this shape has gets the nearest one.
  UnitSigmoid fit(const Tristimulus& rgb, const UnitSigmoid& start = {0, 0, 0}) const;
  /// Linear RGB, in the space, of the reflectance under the space's illuminant.
  Tristimulus rgb_of(const UnitSigmoid& a) const;

 private:
  struct Colour {
    Tristimulus xyz;
    std::array<Tristimulus, 3> derivative;  ///< of xyz with respect to each coefficient
  };
  Colour colour(const UnitSigmoid& a) const;

  Matrix3 to_xyz_;
  Tristimulus white_;
  // Observer times illuminant, resampled to nodes every 5 nm with tent weights. Exact for reflectances that are linear
  // between nodes.
  std::array<std::array<double, five_nm_samples>, 3> weight_{};
};

/// The same curve as a quadratic in the wavelength in nm.
std::array<float, 3> in_nanometres(const UnitSigmoid& a);

}  // namespace lanthorn
