// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "film/filter.h"
#include "film/sensor.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Pixels [x0, x1) x [y0, y1) of the full film.
struct PixelWindow {
  int x0 = 0, y0 = 0, x1 = 1, y1 = 1;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  /// Index, row-major, of the pixel that has this film position, or of the nearest one.
  std::uint32_t pixel_at(const Vec2& raster) const {
    // Clamped first: light from beside the camera falls on places that no integer holds.
    const auto x = static_cast<int>(std::clamp(raster.x, static_cast<float>(x0), static_cast<float>(x1 - 1)));
    const auto y = static_cast<int>(std::clamp(raster.y, static_cast<float>(y0), static_cast<float>(y1 - 1)));
    return static_cast<std::uint32_t>((y - y0) * width() + x - x0);
  }
  friend bool operator==(const PixelWindow&, const PixelWindow&) = default;
};

/// What every integrator is told; together with the scene and the integrator's own parameters it decides the picture,
/// but for `memory`.
struct RenderSettings {
  std::uint64_t seed = 0;
  ColorMode color = ColorMode::rgb;
  int max_depth = 64;         ///< scattering events of a whole path, from light to eye
  std::uint64_t photons = 0;  ///< light paths per pass
  PixelWindow window;         ///< what is rendered
  Filter filter;
  Sensor sensor;
  std::uint64_t memory = std::uint64_t{1} << 30;  ///< bytes for a block of pixels whose light is not known yet
};

}  // namespace lanthorn
