// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "medium/passing.h"

namespace lanthorn {

std::optional<Spectrum> passing_weight(const Medium& medium, float distance, const Spectrum& beta,
                                       const Wavelengths& w) {
  const auto* homogeneous = std::get_if<HomogeneousMedium>(&medium);
  if (homogeneous == nullptr) return {};
  // A flight chooses a wavelength by its throughput, and a distance by the extinction at that wavelength
  // (HomogeneousMedium::fly).
  const Spectrum through = homogeneous->attenuation(distance, w).transmittance;
  const float passing = sum_of(beta * through) / sum_of(beta);
  return passing > 0 ? through / passing : Spectrum();
}

}  // namespace lanthorn
