// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// A straight segment through a medium, in world space.
struct Segment {
  Point origin{0};
  Direction direction{0, 0, 1};  ///< unit length
  float length = infinity;       ///< metres; may be infinite
};

/// Result of a walk over a segment. For every component of the light, the expected value of `weight` is the fraction
/// that the segment transmits to its end (no `distance`) or scatters on the way, per unit of the phase function.
struct Flight {
  std::optional<float> distance;  ///< metres to the scattering event; none: transmitted to the end
  Spectrum weight{1};             ///< to be multiplied into the walk's throughput
  float optical_depth = 0;        ///< of the way flown, as in `Attenuation`
  /// Density of the result: per metre if the walk scattered, else the probability of transmission. None if there is no
  /// closed form (media on grids, which use null-collision tracking).
  std::optional<float> pdf = 1.0f;
};

/// Attenuation of light along a segment.
struct Attenuation {
  Spectrum transmittance{1};
  float optical_depth = 0;  ///< for MIS weights: from the wavelengths' mean extinction; 0 on grids
};

/// Emission and transmittance of a segment.
struct VolumeEmission {
  Spectrum emitted;  ///< volumetric emission along the segment, as radiance at its origin
  Spectrum transmittance{1};
};

}  // namespace lanthorn
