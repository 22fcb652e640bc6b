// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

namespace lanthorn {

/// A half-line or segment. A ray that leaves a surface starts at a point already moved off it (`offset_origin`), so
/// intersection skips no distance.
struct Ray {
  Point origin{0};
  Direction direction{0, 0, 1};  ///< unit length
  float t_max = infinity;        ///< metres
  float time = 0;                ///< in the camera's shutter interval
  /// The footprint of an eye path: at distance t it is width + t · spread metres wide across the ray. 0 if the path
  /// must see everything in full detail.
  float width = 0, spread = 0;
};

}  // namespace lanthorn
