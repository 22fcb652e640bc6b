// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Direct light of point-like lights along the rays that eye paths send through media.
#pragma once

#include "path/direct_light.h"

namespace lanthorn {

/// Single scattering along rays. Next-event estimation from the points where a walk scatters rarely finds a narrow beam
/// in thin fog, and hardly ever the light close to a source. The light of point-like lights is therefore also sampled
/// along the whole ray, as if each point of it scattered (`RayLights`). The balance heuristic combines both techniques,
/// in the measure of light and distance.
///
/// Only rays before the first non-specular scattering use the second technique; later rays are too many for its cost.
class RayLight {
 public:
  /// One sample of the light along the ray. Remembers the ray for `next_event_at`.
  DirectLight along(const PathContext& path, const MediumRay& ray);
  /// Next-event estimation where the walk scatters on the ray seen last, like `next_event`.
  DirectLight next_event_at(const PathContext& path, const MediumVertex& vertex) const;

 private:
  Segment segment_;
  double strength_ = 0;  // of the lights along it; 0: they are not sampled along it
};

}  // namespace lanthorn
