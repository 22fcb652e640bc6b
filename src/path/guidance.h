// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/vec.h"

namespace lanthorn {

class DirectionGuide;

/// What guides a walk at a vertex: with probability `share` its next direction is drawn from the guide, otherwise from
/// the closure. Defensive: the closure's part of the mixture finds what the guide misses.
struct Guidance {
  const DirectionGuide* guide = nullptr;  ///< none: share is 0
  float share = 0;                        ///< in [0,1)

  /// A direction of the guide, world space; none if it has no light.
  std::optional<Direction> sample(const Vec2& u) const;
  /// Density of the mixture, per solid angle, for a (world) direction that the closure alone would take with density
  /// `closure_pdf`; not for delta lobes.
  float pdf(float closure_pdf, const Direction& direction) const;
};

}  // namespace lanthorn
