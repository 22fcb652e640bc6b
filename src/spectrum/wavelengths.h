// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "spectrum/spectrum.h"

namespace lanthorn {

/// The meaning of the four numbers of every `Spectrum` of a path. Methods that cache light paths draw the wavelengths
/// once per pass and share them between eye and light paths; methods without a cache draw them per path.
///
/// Dispersion: a path through an interface with a wavelength-dependent index of refraction is correct only at its hero,
/// `lambda[hero]`. All components of its throughput are still computed. Its contribution is multiplied by `dispersed`:
/// 4 at the hero and 0 elsewhere in spectral mode; in RGB mode the RGB response of the hero over its pdf, whose mean is
/// (1,1,1,0). If eye path and light path have a hero in common, their joint contribution is multiplied once; if each
/// has drawn its own among the four, it is multiplied for each that is dispersed (`LightToMeet`).
struct Wavelengths {
  ColorMode mode = ColorMode::rgb;
  std::uint8_t hero = 0;          ///< index
  std::array<float, 4> lambda{};  ///< nm, in [360, 830]; RGB mode uses only the first
  std::array<float, 4> pdf{};     ///< per nm
  Spectrum dispersed{1, 1, 1, 0};

  /// RGB mode. `u` in [0,1) picks lambda[0], the wavelength at which dispersive interfaces are evaluated.
  static Wavelengths rgb(float u);
  /// Spectral mode: four stratified wavelengths, with a density for which four wavelengths reproduce colours best.
  /// lambda[0] covers the whole visible range as u covers [0,1) (hero wavelength sampling, Wilkie et al. 2014).
  static Wavelengths spectral(float u);

  /// The same wavelengths with another hero. Spectral mode only.
  Wavelengths with_hero(unsigned index) const {
    Wavelengths result = *this;
    result.hero = static_cast<std::uint8_t>(index);
    result.dispersed = Spectrum();
    result.dispersed.v[index] = 4;
    return result;
  }

  /// Mean of the components that carry light.
  float mean_of(const Spectrum& s) const { return mode == ColorMode::rgb ? (s[0] + s[1] + s[2]) / 3 : sum_of(s) / 4; }
  /// Film RGB of a radiance estimate. RGB mode: the estimate itself. Spectral mode: CIE 1931 XYZ / 106.856895,
  /// converted to linear Rec.709, so that the illuminant with Y = 1 has luminance 1. May be slightly negative.
  Rgb to_rgb(const Spectrum& s) const { return mode == ColorMode::rgb ? Rgb{s[0], s[1], s[2]} : spectral_to_rgb(s); }

 private:
  Rgb spectral_to_rgb(const Spectrum& s) const;
};

/// Light of a light path that is stored for eye paths to meet. In spectral mode both paths have drawn their heroes
/// independently, each of the four with probability 1/4. So each path multiplies its own light by `dispersed`: the
/// product is 16 with probability 1/16 at each wavelength if both are dispersed, and its mean is 1. In RGB mode, whose
/// components are not wavelengths, all paths of a pass have one hero, and the path that meets the light multiplies it.
struct LightToMeet {
  Spectrum light;
  bool dispersed = false;  ///< the factor of dispersion is still to be applied

  static LightToMeet of(const Spectrum& light, bool dispersed, const Wavelengths& w) {
    if (!dispersed || w.mode == ColorMode::rgb) return {light, dispersed};
    return {light * w.dispersed, false};
  }
};

/// Radiance at the four wavelengths of a path.
struct SpectralRadiance {
  std::array<float, 4> radiance{};
  std::array<float, 4> lambda{};  ///< nm
  std::array<float, 4> pdf{};     ///< of each wavelength, per nm

  SpectralRadiance() = default;
  /// In spectral mode.
  SpectralRadiance(const Spectrum& s, const Wavelengths& w) : radiance(s.v), lambda(w.lambda), pdf(w.pdf) {}
};

}  // namespace lanthorn
