// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/hash.h"
#include "medium/flight.h"
#include "medium/phase.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// A medium with constant coefficients.
struct HomogeneousMedium {
  SpectrumCurve sigma_a, sigma_s;  ///< absorption and scattering coefficients, per metre
  SpectrumCurve emission;          ///< radiance of an infinitely deep medium without scattering
  HenyeyGreenstein phase;

  /// Extinction coefficient, per metre.
  Spectrum extinction(const Wavelengths& w) const { return sigma_a.evaluate(w) + sigma_s.evaluate(w); }
  /// exp(-extinction length).
  Attenuation attenuation(float length, const Wavelengths& w) const;
  VolumeEmission emission_along(float length, const Wavelengths& w) const;
  /// Samples a distance from the mean of the channels' free-flight densities, weighted by their throughput `beta`
  /// (Wilkie et al. 2014): weights stay bounded however much the channels differ.
  Flight fly(float length, const Spectrum& beta, const Wavelengths& w, HashRng& rng) const;
};

}  // namespace lanthorn
