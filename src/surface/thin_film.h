// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Interference in a transparent film on a dielectric surface:
//   Born & Wolf: Principles of Optics, §1.6.4 (a homogeneous dielectric film) [BW]
//   Belcour & Barla 2017: A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence [B17]
#pragma once

#include <array>

#include "spectrum/spectrum.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// A plane film, at the wavelengths of a path.
struct ThinFilm {
  float eta = 1.3f;               ///< index of refraction relative to the outside, at least 1
  float thickness = 0;            ///< nm; 0: there is no film
  std::array<float, 4> lambda{};  ///< nm, in the order of the components; 0 in RGB mode

  ThinFilm() = default;
  ThinFilm(float eta_, float thickness_, const Wavelengths& w) : eta(eta_), thickness(thickness_) {
    if (w.mode == ColorMode::spectral) lambda = w.lambda;
  }
  explicit operator bool() const { return thickness > 0; }
};

/// Fraction of unpolarised light from the outside that film and surface together reflect; the rest enters the surface.
/// `cos_i` in [0,1] is the cosine outside, `eta` >= 1 the index of the surface relative to the outside, by component.
/// The same from inside, for the refracted direction. In RGB mode it is the mean over white light, weighted by the
/// response of each channel.
Spectrum film_reflectance(const ThinFilm& film, float cos_i, const Spectrum& eta);

/// The index of a dielectric of this reflectance (clamped to [0, 0.9999]) at normal incidence.
Spectrum index_from_reflectance(const Spectrum& reflectance);

}  // namespace lanthorn
