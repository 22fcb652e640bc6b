// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "math/vec.h"

namespace lanthorn {

/// The rendered pixels [x0, x1) x [y0, y1) of the full film.
struct PixelWindow {
  int x0 = 0, y0 = 0, x1 = 1, y1 = 1;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  Vec2 corner() const { return {static_cast<float>(x0), static_cast<float>(y0)}; }
  /// Row-major index of the pixel that contains this film position, or of the nearest one.
  std::uint32_t pixel_at(const Vec2& raster) const {
    // Clamped before conversion: light from outside the view may have positions outside the range of integers.
    const auto x = static_cast<int>(std::clamp(raster.x, static_cast<float>(x0), static_cast<float>(x1 - 1)));
    const auto y = static_cast<int>(std::clamp(raster.y, static_cast<float>(y0), static_cast<float>(y1 - 1)));
    return static_cast<std::uint32_t>((y - y0) * width() + x - x0);
  }
  /// The window with as many more pixels on each side, where a film of this size has them.
  PixelWindow grown(int margin, int film_width, int film_height) const {
    return {std::max(0, x0 - margin), std::max(0, y0 - margin), std::min(film_width, x1 + margin),
            std::min(film_height, y1 + margin)};
  }
  friend bool operator==(const PixelWindow&, const PixelWindow&) = default;
};

}  // namespace lanthorn
