// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/hash.h"
#include "medium/flight.h"
#include "medium/phase.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// A medium that is the same everywhere.
struct HomogeneousMedium {
  SpectrumCurve sigma_a, sigma_s;  ///< absorbed, scattered: per metre
  SpectrumCurve emission;          ///< radiance that it would have if infinitely deep and free of scattering
  HenyeyGreenstein phase;

  /// exp(-sigma_t length).
  Spectrum transmittance(float length, const Wavelengths& w) const;
  /// Draws a distance with the mean over the channels, weighted by their throughput `beta`, of the channels'
  /// free-flight densities (Wilkie et al. 2014): weights stay bounded however different the channels are.
  Flight fly(float length, const Spectrum& beta, const Wavelengths& w, HashRng& rng) const;
};

}  // namespace lanthorn
