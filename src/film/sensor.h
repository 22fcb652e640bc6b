// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "spectrum/white_balance.h"

namespace lanthorn {

/// Processing of light by the film before it is accumulated.
struct Sensor {
  std::optional<RgbMatrix> balance;  ///< linear map of colours; none: unchanged
  /// Limit of the CIE XYZ components of a sample. A sample with a larger component is scaled down to it, which reduces
  /// noise and loses energy, as pbrt-v4's "maxcomponentvalue". Splats are not limited, because each is one of many.
  std::optional<float> largest_component;

  /// Limit of the components of what a path adds to a pixel, emission that is seen directly left out. Against
  /// fireflies; loses energy.
  std::optional<float> path_limit{};

  /// Factor by which such light of a path is scaled down.
  float path_factor(const Rgb& light) const {
    if (!path_limit) return 1;
    const float largest = max_component(light);
    return largest > *path_limit ? *path_limit / largest : 1.0f;
  }
  /// Factor by which a sample of this colour is scaled down.
  float clamp_factor(const Rgb& color) const {
    if (!largest_component) return 1;
    static const RgbMatrix to_xyz = rec709_to_xyz();
    const float largest = max_component(to_xyz * color);
    return largest > *largest_component ? *largest_component / largest : 1.0f;
  }
  Rgb balanced(const Rgb& color) const { return balance ? *balance * color : color; }
};

}  // namespace lanthorn
