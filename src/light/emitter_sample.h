// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

namespace lanthorn {

/// A point of an emitter, sampled uniformly by area with density 1 / area.
struct EmitterPoint {
  Point point{0};
  Normal normal{0, 0, 1};  ///< natural geometric normal, unit
};

/// A point of an emitter, sampled from a receiving point.
struct EmitterDirection {
  Point point{0};
  Normal normal{0, 0, 1};  ///< natural geometric normal, unit
  Direction wi{0, 0, 1};   ///< from the receiving point to the emitter
  float distance = 0;      ///< metres
  float pdf = 0;           ///< per solid angle at the receiving point
};

/// A cone that contains all natural normals of an emitter.
struct NormalCone {
  Direction axis{0, 0, 1};
  float cos = -1;  ///< cosine of the half angle; -1: any normal
};

}  // namespace lanthorn
