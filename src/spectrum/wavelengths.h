// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "spectrum/spectrum.h"

namespace lanthorn {

/// The meaning of the four numbers of every `Spectrum` of a path. Methods that cache light paths draw one `Wavelengths`
/// per pass and share it between eye and light paths; methods without a cache draw one per path.
///
/// Dispersion: a path through an interface with a wavelength-dependent index of refraction is correct only at
/// `lambda[0]`, the hero wavelength. All components of its throughput are still computed. Its contribution is
/// multiplied by `dispersed`, once, even if several subpaths are dispersed (spectral mode: (4,0,0,0); RGB mode: the RGB
/// response of lambda[0] over its pdf, mean (1,1,1,0)).
struct Wavelengths {
  ColorMode mode = ColorMode::rgb;
  std::array<float, 4> lambda{};  ///< nm, in [360, 830]; RGB mode uses only the first
  std::array<float, 4> pdf{};     ///< per nm
  Spectrum dispersed{1, 1, 1, 0};

  /// RGB mode. `u` in [0,1) picks lambda[0], the wavelength at which dispersive interfaces are evaluated.
  static Wavelengths rgb(float u);
  /// Spectral mode: four stratified wavelengths, with a density for which four wavelengths reproduce colours best.
  /// lambda[0] covers the whole visible range as u covers [0,1) (hero wavelength sampling, Wilkie et al. 2014).
  static Wavelengths spectral(float u);

  /// Mean of the components that carry light.
  float mean_of(const Spectrum& s) const { return mode == ColorMode::rgb ? (s[0] + s[1] + s[2]) / 3 : sum_of(s) / 4; }
  /// Film RGB of a radiance estimate. RGB mode: the estimate itself. Spectral mode: CIE 1931 XYZ / 106.856895,
  /// converted to linear Rec.709, so that the illuminant with Y = 1 has luminance 1. May be slightly negative.
  Rgb to_rgb(const Spectrum& s) const { return mode == ColorMode::rgb ? Rgb{s[0], s[1], s[2]} : spectral_to_rgb(s); }

 private:
  Rgb spectral_to_rgb(const Spectrum& s) const;
};

}  // namespace lanthorn
