// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include "lanthorn/transform.h"
#include "medium/density.h"
#include "medium/phase.h"
#include "medium/tracking.h"
#include "spectrum/curve.h"

namespace lanthorn {

/// Emission with one spectrum, constant or multiplied by a grid of factors.
struct SpectrumEmission {
  SpectrumCurve radiance;
  std::optional<SampledGrid<float>> factor;
};
/// Black-body emission with peak value `factor`: T = (temperature - offset) * scale kelvin; 0 up to 100 K.
struct BlackbodyEmission {
  Density temperature;
  float offset = 0, scale = 1;
  float factor = 1;
};

/// A medium whose absorption and scattering coefficients are constant spectra times a density.
struct DensityMedium {
  SpectrumCurve sigma_a, sigma_s;  ///< per metre, where the density is 1
  HenyeyGreenstein phase;
  Transform to_medium;  ///< from the world
  Density density;
  BlockGrid majorants;
  std::optional<std::variant<SpectrumEmission, BlackbodyEmission>> emission;

  float extinction_bound(const Wavelengths& w) const {
    return max_component(sigma_a.evaluate(w) + sigma_s.evaluate(w));
  }
  LocalCoefficients at(const Point& p, const Wavelengths& w) const;
  Spectrum emitted(const Point& p, const Wavelengths& w) const;
};

/// A medium with RGB coefficients on grids.
struct RgbGridMedium {
  std::optional<SampledGrid<Vec3>> sigma_a, sigma_s;  ///< red, green, blue, times `scale` per metre; none: 1
  std::optional<SampledGrid<Vec3>> emission;          ///< radiance
  float scale = 1;
  HenyeyGreenstein phase;
  Transform to_medium;
  BlockGrid majorants;  ///< of the largest component of sigma_a + sigma_s, without `scale`

  float extinction_bound(const Wavelengths& w) const;
  LocalCoefficients at(const Point& p, const Wavelengths& w) const;
  Spectrum emitted(const Point& p, const Wavelengths& w) const;

 private:
  Spectrum coefficient(const std::optional<SampledGrid<Vec3>>& grid, const Point& p, const Wavelengths& w) const;
};

}  // namespace lanthorn
