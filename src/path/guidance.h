// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/vec.h"

namespace lanthorn {

class DirectionGuide;

/// Path guiding at a vertex: the walk draws its next direction from the guide with probability `share`, otherwise from
/// the closure. This is defensive sampling: the closure's part of the mixture covers directions that the guide misses.
struct Guidance {
  const DirectionGuide* guide = nullptr;  ///< null if share is 0
  float share = 0;                        ///< in [0,1)

  /// Draws a direction from the guide, world space. Empty if the guide has no flux.
  std::optional<Direction> sample(const Vec2& u) const;
  /// Density of the mixture, per solid angle, for a direction (world space) that the closure alone samples with density
  /// `closure_pdf`. Not for delta lobes.
  float pdf(float closure_pdf, const Direction& direction) const;
};

}  // namespace lanthorn
