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

inline constexpr float lambda_min = 360;  ///< nm
inline constexpr float lambda_max = 830;  ///< nm

/// A spectrum tabulated at every nanometre of [360, 830].
struct DenseSpectrum {
  std::array<float, 471> values{};
  /// Value at the nearest nanometre; 0 outside the table.
  float at(float nm) const;
};

/// RGB primaries and white of numbers in a scene file.
enum class ColorSpace : std::uint8_t { srgb, dci_p3, rec2020, aces2065_1 };

/// A spectral distribution as plain data, ready to be evaluated in either colour mode: 40-odd bytes, no ownership
/// (`table` points into static data or into the scene's table store and must outlive the curve).
///
/// value(nm) = scale * shape(nm) [* illuminant(nm) for emission given as RGB], where shape is 1 (constant), Jakob &
/// Hanika's (2019) sigmoid of a quadratic, or a table. `rgb` is the whole curve in RGB mode, scale included.
struct SpectrumCurve {
  enum class Shape : std::uint8_t { constant, sigmoid, table, sigmoid_times_table };

  Shape shape = Shape::constant;
  float scale = 0;
  std::array<float, 3> c{};  ///< sigmoid coefficients of lambda^2, lambda, 1
  const DenseSpectrum* table = nullptr;
  Rgb rgb;

  static SpectrumCurve constant(float value);
  /// A reflectance in [0,1] (values outside are clamped).
  static SpectrumCurve albedo(const Rgb& rgb, ColorSpace space = ColorSpace::srgb);
  /// Any non-negative RGB that is not a light: indices, absorption, scale factors.
  static SpectrumCurve unbounded(const Rgb& rgb, ColorSpace space = ColorSpace::srgb);
  /// A light of this RGB: times the colour space's illuminant normalised to Y = 1, so that (1,1,1) has luminance 1.
  static SpectrumCurve illuminant(const Rgb& rgb, ColorSpace space = ColorSpace::srgb);
  /// A tabulated curve as it is. Its RGB-mode value is the average under Rec.709's response to equal energy
  /// (a reflectance or index), clamped to be non-negative.
  static SpectrumCurve tabulated(const DenseSpectrum* table);
  /// A tabulated light: `table` should be normalised to Y = 1 by the caller (`normalized_luminance`); its RGB-mode
  /// value is its colour, negative components (light outside Rec.709) taken as 0.
  static SpectrumCurve tabulated_light(const DenseSpectrum* table);

  /// The same curve times s.
  SpectrumCurve scaled(float s) const;
  /// True if it is 0 everywhere.
  bool is_black() const { return scale == 0; }
  /// True if its value depends on the wavelength (a dispersive index of refraction).
  bool varies() const { return shape != Shape::constant; }
  /// Value at one wavelength, spectral meaning.
  float at(float nm) const;
  /// Values in the current colour mode.
  Spectrum evaluate(const Wavelengths& w) const;
};

/// Luminance Y of a curve: ∫ s(λ) ȳ(λ) dλ / ∫ ȳ.
float luminance_of(const DenseSpectrum& s);
/// The table scaled to luminance 1 (unchanged if black).
DenseSpectrum normalized_luminance(DenseSpectrum s);

/// Planck's law at T kelvin, any scale; normalise with `normalized_luminance` for a light.
DenseSpectrum blackbody(float kelvin);
/// Piecewise-linear samples (wavelengths in nm ascending) resampled to the dense table; 0 outside the given range for
/// lights, the end value for everything else (`extend_ends`).
DenseSpectrum resample(const float* nm, const float* values, std::size_t count, bool extend_ends);
/// What a unit at each of these wavelengths (nm, ascending), joined by straight lines and with extended ends, adds to
/// the RGB-mode value of a tabulated curve: their sum is (1,1,1). Components may be negative.
std::vector<Rgb> rgb_shares(std::span<const float> nm);
/// Spectra that pbrt files name: "metal-Ag-eta", "metal-Ag-k" (also Al, Au, Cu, CuZn, MgO, TiO2), "glass-BK7",
/// "glass-BAF10", "glass-FK51A", "glass-LASF9", "glass-F5", "glass-F10", "glass-F11" (SF5, SF10, SF11), "stdillum-A",
/// "stdillum-D50", "stdillum-D65", "stdillum-F1".."F12". Illuminants have Y = 1; the glasses are SCHOTT's N- glasses,
/// pbrt's numbers. Null if the name is not known; the table lives as long as the program.
const DenseSpectrum* named_spectrum(const char* name);

/// Jakob & Hanika (2019) coefficients of a reflectance, for textures: from a table made at build time, trilinearly
/// interpolated.
std::array<float, 3> sigmoid_coefficients(const Rgb& rgb);
/// Sigmoid reflectance at the path's wavelengths (spectral mode), or the RGB itself.
Spectrum evaluate_albedo(const Rgb& rgb, const Wavelengths& w);
/// RGB emission of an image texel: the illuminant of sRGB times the upsampled colour (any non-negative magnitude).
Spectrum evaluate_illuminant(const Rgb& rgb, const Wavelengths& w);

}  // namespace lanthorn
