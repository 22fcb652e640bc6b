// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Wavelengths are drawn with density proportional to 1 / cosh^2(b (lambda - centre)), a fit to the eye's response. Its
// cumulative distribution inverts in closed form (Radziszewski, Boryczko and Alda 2009, "An improved technique for full
// spectral rendering", section 4). Each path has four stratified wavelengths (Wilkie et al. 2014, "Hero wavelength
// spectral sampling").
#include "spectrum/wavelengths.h"

#include <algorithm>
#include <cmath>

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

constexpr float steepness = 0.0072f;        // per nm
constexpr float centre = 538;               // nm
constexpr float tanh_min = -0.8569106255f;  // tanh(steepness * (lambda_min - centre))
constexpr float tanh_max = 0.9705913469f;   // tanh(steepness * (lambda_max - centre))

struct WavelengthSample {
  float lambda, pdf;
};

WavelengthSample sample_visible(float u) {
  const float t = tanh_min + (tanh_max - tanh_min) * u;
  const float lambda = centre + (0.5f / steepness) * std::log((1 + t) / (1 - t));
  return {std::clamp(lambda, lambda_min, lambda_max), steepness / (tanh_max - tanh_min) * (1 - t * t)};
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
