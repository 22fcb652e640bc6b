// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "spectrum/spectrum.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// A spectrum tabulated at every nanometre of [360, 830].
struct DenseSpectrum {
  std::array<float, 471> values{};
  /// Value at the nearest nanometre; 0 outside the table.
  float at(float nm) const;
};

/// A spectral distribution as plain data, evaluated in either colour mode. 40-odd bytes, no ownership: `table` points
/// into static data or into the scene's table store and must outlive the curve.
///
/// value(nm) = scale * shape(nm) [* illuminant(nm) for emission given as RGB]. The shape is 1 (constant), Jakob &
/// Hanika's (2019) sigmoid of a quadratic, or a table. `rgb` is the whole curve in RGB mode, scale included.
struct SpectrumCurve {
  enum class Shape : std::uint8_t { constant, sigmoid, table, sigmoid_times_table };

  Shape shape = Shape::constant;
  float scale = 0;
  std::array<float, 3> c{};  ///< sigmoid coefficients of lambda^2, lambda, 1
  const DenseSpectrum* table = nullptr;
  Rgb rgb;

  static SpectrumCurve constant(float value);
  /// A reflectance in [0,1]; values outside are clamped.
  static SpectrumCurve albedo(const Rgb& rgb, ColorSpace space = ColorSpace::srgb);
  /// Any non-negative RGB quantity that is not emission: indices, absorption, scale factors.
  static SpectrumCurve unbounded(const Rgb& rgb, ColorSpace space = ColorSpace::srgb);
  /// Emission of this RGB: multiplied by the colour space's illuminant normalised to Y = 1, so that (1,1,1) has
  /// luminance 1.
  static SpectrumCurve illuminant(const Rgb& rgb, ColorSpace space = ColorSpace::srgb);
  /// A tabulated curve, unchanged. Its RGB-mode value is the mean weighted by the Rec.709 response to equal energy (for
  /// a reflectance or index), negative components clamped to 0.
  static SpectrumCurve tabulated(const DenseSpectrum* table);
  /// A tabulated light. The caller should normalise `table` to Y = 1 (`normalized_luminance`). Its RGB-mode value is
  /// its colour; negative components (light outside Rec.709) are clamped to 0.
  static SpectrumCurve tabulated_light(const DenseSpectrum* table);

  /// The curve multiplied by s.
  SpectrumCurve scaled(float s) const;
  /// True if the curve is 0 everywhere.
  bool is_black() const { return scale == 0; }
  /// True if the value depends on the wavelength (for example a dispersive index of refraction).
  bool varies() const { return shape != Shape::constant; }
  /// Value at one wavelength, as in spectral mode.
  float at(float nm) const;
  /// Values in the colour mode of `w`.
  Spectrum evaluate(const Wavelengths& w) const {
    return w.mode == ColorMode::rgb ? Spectrum(rgb.r, rgb.g, rgb.b, 0) : at_wavelengths(w);
  }

 private:
  Spectrum at_wavelengths(const Wavelengths& w) const;
};

/// Luminance Y of a spectrum: ∫ s(λ) ȳ(λ) dλ / ∫ ȳ(λ) dλ.
float luminance_of(const DenseSpectrum& s);
/// The table scaled to luminance 1; unchanged if black.
DenseSpectrum normalized_luminance(DenseSpectrum s);

/// Planck's law at T kelvin, at an arbitrary scale; for a light, normalise with `normalized_luminance`.
DenseSpectrum blackbody(float kelvin);
/// Resamples piecewise-linear samples (wavelengths in nm, ascending) to the dense table. Outside the given range: the
/// end value if `extend_ends`, else 0 (for lights).
DenseSpectrum resample(const float* nm, const float* values, std::size_t count, bool extend_ends);
/// Weight of each sample of a piecewise-linear tabulated curve (wavelengths in nm, ascending; extended ends) in the
/// curve's RGB-mode value. The weights sum to (1,1,1); components may be negative.
std::vector<Rgb> rgb_shares(std::span<const float> nm);
/// The spectra that pbrt files refer to by name: "metal-Ag-eta", "metal-Ag-k" (also Al, Au, Cu, CuZn, MgO, TiO2),
/// "glass-BK7", "glass-BAF10", "glass-FK51A", "glass-LASF9", "glass-F5", "glass-F10", "glass-F11" (SF5, SF10, SF11),
/// "stdillum-A", "stdillum-D50", "stdillum-D65", "stdillum-F1".."F12". Illuminants have Y = 1. The glasses are SCHOTT's
/// N- glasses, with pbrt's values. Null if the name is unknown; the table lives as long as the program.
const DenseSpectrum* named_spectrum(const char* name);

/// Jakob & Hanika (2019) coefficients of a reflectance, for textures: interpolated trilinearly in a table made at build
/// time.
std::array<float, 3> sigmoid_coefficients(const Rgb& rgb);
/// Sigmoid reflectance at the path's wavelengths (spectral mode), or the RGB value itself (RGB mode).
Spectrum evaluate_albedo(const Rgb& rgb, const Wavelengths& w);
/// RGB emission of an image texel: the illuminant of sRGB times the upsampled colour, of any non-negative magnitude.
Spectrum evaluate_illuminant(const Rgb& rgb, const Wavelengths& w);

}  // namespace lanthorn
