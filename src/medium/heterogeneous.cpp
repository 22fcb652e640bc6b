// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "medium/heterogeneous.h"

#include <array>
#include <cmath>

namespace lanthorn {

namespace {

constexpr float coldest = 100;  // kelvin; lower temperatures have no visible emission

// Planck's law at a wavelength in nm, divided by its maximum at the same temperature.
float relative_blackbody(float kelvin, float nm) {
  constexpr double second_radiation_constant = 1.438776877e7;  // nm K
  constexpr double wien = 2.897771955e6;                       // nm K
  const auto planck = [&](double lambda) {
    return 1 / (std::pow(lambda, 5) * std::expm1(second_radiation_constant / (lambda * static_cast<double>(kelvin))));
  };
  return static_cast<float>(planck(static_cast<double>(nm)) / planck(wien / static_cast<double>(kelvin)));
}

// RGB-mode colour of `relative_blackbody`, tabulated on a geometric scale of temperatures.
class BlackbodyColors {
 public:
  BlackbodyColors() {
    for (std::size_t i = 0; i < colors_.size(); ++i) {
      const float kelvin = coldest * std::pow(hottest / coldest, static_cast<float>(i) / last);
      DenseSpectrum spectrum;
      for (std::size_t k = 0; k < spectrum.values.size(); ++k)
        spectrum.values[k] = relative_blackbody(kelvin, lambda_min + static_cast<float>(k));
      const Rgb rgb = SpectrumCurve::tabulated_light(&spectrum).rgb;
      colors_[i] = {rgb.r, rgb.g, rgb.b};
    }
  }
  Spectrum at(float kelvin) const {
    const float x = std::clamp(last * std::log(kelvin / coldest) / std::log(hottest / coldest), 0.0f, last);
    const auto i = std::min(static_cast<std::size_t>(x), colors_.size() - 2);
    const float f = x - static_cast<float>(i);
    const Vec3 color = (1 - f) * colors_[i] + f * colors_[i + 1];
    return {color.x, color.y, color.z, 0};
  }

 private:
  static constexpr float hottest = 40'000;
  static constexpr float last = 1023;
  std::array<Vec3, 1024> colors_;
};

Spectrum blackbody_radiance(float kelvin, const Wavelengths& w) {
  if (!(kelvin > coldest)) return {};
  if (w.mode == ColorMode::rgb) {
    static const BlackbodyColors colors;
    return colors.at(kelvin);
  }
  Spectrum s;
  for (int i = 0; i < 4; ++i) s[i] = relative_blackbody(kelvin, w.lambda[static_cast<unsigned>(i)]);
  return s;
}

Spectrum radiance(const SpectrumEmission& emission, const Point& p, const Wavelengths& w) {
  return emission.radiance.evaluate(w) * (emission.factor ? emission.factor->at(p) : 1.0f);
}
Spectrum radiance(const BlackbodyEmission& emission, const Point& p, const Wavelengths& w) {
  return emission.factor *
         blackbody_radiance((density_at(emission.temperature, p) - emission.offset) * emission.scale, w);
}

// Sigmoid spectra stay below 1, so the colour is first scaled to at most 1/2.
Spectrum unbounded(const Vec3& rgb, const Wavelengths& w) {
  const float largest = max_component(rgb);
  if (!(largest > 0)) return {};
  if (w.mode == ColorMode::rgb) return {rgb.x, rgb.y, rgb.z, 0};
  const float m = 2 * largest;
  return m * evaluate_albedo({rgb.x / m, rgb.y / m, rgb.z / m}, w);
}

}  // namespace

LocalCoefficients DensityMedium::at(const Point& p, const Wavelengths& w) const {
  const float d = density_at(density, p);
  return {d * sigma_a.evaluate(w), d * sigma_s.evaluate(w)};
}

Spectrum DensityMedium::emitted(const Point& p, const Wavelengths& w) const {
  const float d = emission ? density_at(density, p) : 0;
  if (!(d > 0)) return {};
  return d * sigma_a.evaluate(w) * std::visit([&](const auto& g) { return radiance(g, p, w); }, *emission);
}

float RgbGridMedium::extinction_bound(const Wavelengths& w) const {
  // A spectrum may reach twice the largest component of its colour (see `unbounded`).
  return w.mode == ColorMode::rgb ? scale : 2 * scale;
}

Spectrum RgbGridMedium::coefficient(const std::optional<SampledGrid<Vec3>>& grid, const Point& p,
                                    const Wavelengths& w) const {
  return scale * unbounded(grid ? grid->at(p) : Vec3(1), w);
}

LocalCoefficients RgbGridMedium::at(const Point& p, const Wavelengths& w) const {
  return {coefficient(sigma_a, p, w), coefficient(sigma_s, p, w)};
}

Spectrum RgbGridMedium::emitted(const Point& p, const Wavelengths& w) const {
  if (!emission || glm::any(glm::lessThan(p, majorants.box().min)) ||
      glm::any(glm::greaterThan(p, majorants.box().max)))
    return {};
  const Vec3 e = emission->at(p);
  return coefficient(sigma_a, p, w) * evaluate_illuminant({e.x, e.y, e.z}, w);
}

}  // namespace lanthorn
