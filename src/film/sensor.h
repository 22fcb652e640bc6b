// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "spectrum/white_balance.h"

namespace lanthorn {

/// What a film does to light before it counts it.
struct Sensor {
  std::optional<RgbMatrix> balance;  ///< of colours; none: they stay as they are
  /// A sample (not a splat, which is one of many) of which a component of CIE XYZ is larger is scaled down to it: less
  /// noise and too little light, as pbrt-v4's "maxcomponentvalue".
  std::optional<float> largest_component;

  /// The factor by which a sample of this colour is scaled down.
  float clamp_factor(const Rgb& color) const {
    if (!largest_component) return 1;
    static const RgbMatrix to_xyz = rec709_to_xyz();
    const float largest = max_component(to_xyz * color);
    return largest > *largest_component ? *largest_component / largest : 1.0f;
  }
  Rgb balanced(const Rgb& color) const { return balance ? *balance * color : color; }
};

}  // namespace lanthorn
