// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "spectrum/rgb_matrix.h"

namespace lanthorn {

/// Processing of light by the film before it is accumulated.
struct Sensor {
  std::optional<RgbMatrix> balance;  ///< linear map of colours; nullopt: unchanged
  /// Limit of the CIE XYZ components of a sample, as pbrt-v4's "maxcomponentvalue". A sample with a larger component is
  /// scaled down to it, which reduces noise but loses energy. Splats are not limited, because each is one of many.
  std::optional<float> largest_component;

  /// Clamps each path's contribution to a pixel, except for directly visible lights: removes fireflies, biased.
  std::optional<float> path_limit{};

  /// Factor that clamps a path's light to `path_limit`.
  float path_factor(const Rgb& light) const {
    if (!path_limit) return 1;
    const float largest = max_component(light);
    return largest > *path_limit ? *path_limit / largest : 1.0f;
  }
  /// Factor that clamps a sample's colour to `largest_component`.
  float clamp_factor(const Rgb& color) const {
    if (!largest_component) return 1;
    static const RgbMatrix to_xyz = rec709_to_xyz();
    const float largest = max_component(to_xyz * color);
    return largest > *largest_component ? *largest_component / largest : 1.0f;
  }
  Rgb balanced(const Rgb& color) const { return balance ? *balance * color : color; }
};

}  // namespace lanthorn
