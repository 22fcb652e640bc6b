// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/scaled_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace lanthorn {

ViewOptions scaled(ViewOptions options, const description::Film& film, double share) {
  const std::array<int, 2> full = options.resolution.value_or(std::array<int, 2>{film.width, film.height});
  const auto scale = [share](int x) { return static_cast<int>(std::lround(share * x)); };
  options.resolution = {std::max(1, scale(full[0])), std::max(1, scale(full[1]))};
  if (options.crop) {
    const auto& [x0, y0, x1, y1] = *options.crop;
    const auto& [width, height] = *options.resolution;
    const int left = std::min(scale(x0), width - 1), top = std::min(scale(y0), height - 1);
    options.crop = {left, top, std::clamp(scale(x1), left + 1, width), std::clamp(scale(y1), top + 1, height)};
  }
  return options;
}

RenderOptions coarse_options(RenderOptions options, const description::Film& film, double share, double photons) {
  constexpr double fewest = 8000;
  static_cast<ViewOptions&>(options) = scaled(options, film, share);
  options.photons =
      static_cast<std::uint64_t>(std::min(std::max(fewest, photons * share * share), std::max(1.0, photons)));
  options.pass_range.reset();
  return options;
}

}  // namespace lanthorn
