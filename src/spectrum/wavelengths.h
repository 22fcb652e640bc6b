// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "spectrum/spectrum.h"

namespace lanthorn {

enum class ColorMode : std::uint8_t { rgb, spectral };

/// What the four numbers of every `Spectrum` of a path mean. Methods that cache light paths draw one `Wavelengths` per
/// pass and share it between eye and light paths; methods that cache nothing draw one per path.
///
/// Dispersion: a path that has met a wavelength-dependent index of refraction is right at `lambda[0]`, the hero, alone.
/// Such a path stays unmasked; its contribution is multiplied, once however many of its parts are dispersed, by
/// `dispersed` (spectral mode: (4,0,0,0); RGB mode: the RGB response of lambda[0] over its pdf, mean (1,1,1,0)).
struct Wavelengths {
  ColorMode mode = ColorMode::rgb;
  std::array<float, 4> lambda{};  ///< nm, in [360, 830]; RGB mode uses the first alone
  std::array<float, 4> pdf{};     ///< per nm
  Spectrum dispersed{1, 1, 1, 0};

  /// RGB mode; `u` in [0,1) picks lambda[0], the wavelength at which dispersive interfaces are evaluated.
  static Wavelengths rgb(float u);
  /// Spectral mode: four stratified wavelengths importance-sampled for the eye's response; lambda[0] covers the whole
  /// visible range as u runs over [0,1) (hero wavelength sampling, Wilkie et al. 2014).
  static Wavelengths spectral(float u);

  /// Film RGB of a radiance estimate: the estimate itself in RGB mode; CIE 1931 XYZ / 106.856895 to linear Rec.709 in
  /// spectral mode (so that the illuminant of Y = 1 gives luminance 1). May be slightly negative.
  Rgb to_rgb(const Spectrum& s) const;
};

}  // namespace lanthorn
