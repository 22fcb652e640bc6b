// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// A straight way through a medium, in world space.
struct Segment {
  Point origin{0};
  Direction direction{0, 0, 1};  ///< unit length
  float length = infinity;       ///< metres; may be infinite
};

/// What became of a walk on a segment. For any part of the light, `weight` in the mean is what the segment lets through
/// to its end (no `distance`) or scatters on the way, per unit of the phase function.
struct Flight {
  std::optional<float> distance;  ///< metres to where it scattered; none: it got through
  Spectrum weight{1};             ///< factor of the walk's throughput
  /// Density of what happened: per metre if it scattered, else the probability of getting through. None where it has no
  /// closed form (media on grids, which are tracked).
  std::optional<float> pdf = 1.0f;
  Spectrum emitted;  ///< radiance that the medium itself adds along the segment, seen from its origin
};

}  // namespace lanthorn
