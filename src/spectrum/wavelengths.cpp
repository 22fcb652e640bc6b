// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Each path has four wavelengths, equidistant in the cumulative distribution (Wilkie et al. 2014, "Hero wavelength
// spectral sampling"): a rectangle rule with four nodes. The colour noise of paths is the error of that rule for
// integrals of the film's response times smooth spectra. A density in proportion to the eye's response (Radziszewski,
// Boryczko and Alda 2009) leaves the blue of white light a relative variance of .34, since one node of four lies where
// blue is seen. The density here was fitted to this error instead.
#include "spectrum/wavelengths.h"

#include <algorithm>

#include "spectrum/cie.h"

namespace lanthorn {
namespace {

struct alignas(16) Response {
  float r = 0, g = 0, b = 0;
};
using ResponseTable = std::array<Response, spectrum_samples>;

constexpr Tristimulus rec709_response(std::size_t i) { return xyz_to_rec709 * ((1 / cie_y_integral) * cie_1931[i]); }

/// Rec.709 response per unit of energy per nm, scaled such that illuminant D65 with Y = 1 integrates to (1,1,1).
constexpr ResponseTable film_response = [] {
  ResponseTable table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Tristimulus c = rec709_response(i);
    table[i] = {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
  }
  return table;
}();

/// The same response, scaled such that each channel integrates to 1 over [lambda_min, lambda_max] if every wavelength
/// uses the nearest entry (the two end entries then cover half a nanometre each).
constexpr ResponseTable unit_response = [] {
  const auto width = [](std::size_t i) { return i == 0 || i + 1 == spectrum_samples ? 0.5 : 1.0; };
  Tristimulus sum;
  for (std::size_t i = 0; i < spectrum_samples; ++i) sum = sum + width(i) * rec709_response(i);
  ResponseTable table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Tristimulus c = rec709_response(i);
    table[i] = {static_cast<float>(c.x / sum.x), static_cast<float>(c.y / sum.y), static_cast<float>(c.z / sum.z)};
  }
  return table;
}();

const Response& at(const ResponseTable& table, float nm) {
  return table[static_cast<unsigned>(nm - lambda_min + 0.5f)];
}

/// Density of wavelengths, not normalised: a plateau over the range that the eye sees. The five numbers minimise the
/// mean squared error of the rectangle rule with 4, 8 and 16 nodes (weights 1, 8, 200) over seven smooth reflectances
/// under D65, equal energy and black bodies of 2856 and 5000 K, in linear Rec.709. The floor keeps the density positive
/// at the ends, which a film with spectral buckets may use.
constexpr double density_of(double nm) {
  const auto smooth_step = [](double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  };
  constexpr double floor = 0.04;
  return smooth_step((nm - 376) / (440 - 376)) * smooth_step((729 - nm) / (729 - 616)) * (1 - 0.16 * (nm - 530) / 100) +
         floor;
}

constexpr std::size_t wavelength_cells = 512;

/// Bounds of cells of equal probability, nm.
constexpr std::array<float, wavelength_cells + 1> cell_bounds = [] {
  constexpr std::size_t steps_per_nm = 4, steps = steps_per_nm * (spectrum_samples - 1);
  const auto nm_at = [](double step) { return double{lambda_min} + step / steps_per_nm; };
  double total = 0;
  for (std::size_t i = 0; i < steps; ++i) total += density_of(nm_at(static_cast<double>(i) + 0.5));
  std::array<float, wavelength_cells + 1> bounds{};
  bounds.fill(lambda_max);
  double sum = 0;
  for (std::size_t i = 0, next = 0; i < steps && next < wavelength_cells; ++i) {
    const double here = density_of(nm_at(static_cast<double>(i) + 0.5)) / total * wavelength_cells;
    for (; next < wavelength_cells && static_cast<double>(next) <= sum + here; ++next)
      bounds[next] = static_cast<float>(nm_at(static_cast<double>(i) + (static_cast<double>(next) - sum) / here));
    sum += here;
  }
  return bounds;
}();

struct WavelengthSample {
  float lambda, pdf;
};

WavelengthSample sample_visible(float u) {
  const float place = u * wavelength_cells;
  const auto cell = static_cast<std::size_t>(place);
  const float width = cell_bounds[cell + 1] - cell_bounds[cell];
  const float lambda = cell_bounds[cell] + (place - static_cast<float>(cell)) * width;
  return {std::min(lambda, lambda_max), 1 / (wavelength_cells * width)};
}

}  // namespace

Wavelengths Wavelengths::rgb(float u) {
  const WavelengthSample s = sample_visible(u);
  const Response& r = at(unit_response, s.lambda);
  Wavelengths w;
  w.lambda[0] = s.lambda;
  w.pdf[0] = s.pdf;
  w.dispersed = Spectrum(r.r, r.g, r.b, 0) * (1 / s.pdf);
  return w;
}

Wavelengths Wavelengths::spectral(float u) {
  Wavelengths w;
  w.mode = ColorMode::spectral;
  w.dispersed = Spectrum(4, 0, 0, 0);
  for (unsigned i = 0; i < 4; ++i) {
    const float shifted = u + 0.25f * static_cast<float>(i);
    const WavelengthSample s = sample_visible(shifted < 1 ? shifted : shifted - 1);
    w.lambda[i] = s.lambda;
    w.pdf[i] = s.pdf;
  }
  return w;
}

Rgb Wavelengths::spectral_to_rgb(const Spectrum& s) const {
  if (s.is_black()) return {};
  Rgb sum;
  for (unsigned i = 0; i < 4; ++i) {
    const Response& r = at(film_response, lambda[i]);
    sum += (0.25f * s.v[i] / pdf[i]) * Rgb{r.r, r.g, r.b};
  }
  return sum;
}

}  // namespace lanthorn
