// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Direct light of lights at points along the rays that eye paths send through media.
#pragma once

#include "path/direct_light.h"

namespace lanthorn {

/// Single scattering along rays. Next-event estimation where a walk scatters seldom finds a narrow beam in thin fog,
/// and hardly ever what is close to a light. So the light of lights at points is also sampled along the ray as if each
/// point of it scattered, where these lights shine (`RayLights`). The balance heuristic joins both techniques, in the
/// measure of light and distance.
///
/// Only the rays before the first scattering that is not specular have the second technique: later ones are too many
/// for what it costs.
class RayLight {
 public:
  /// One sample of the light along the ray, which is remembered for `next_event_at`.
  DirectLight along(const PathContext& path, const MediumRay& ray);
  /// Next-event estimation where the walk scatters at the end of the ray seen last, as `next_event`.
  DirectLight next_event_at(const PathContext& path, const MediumVertex& vertex) const;

 private:
  Segment segment_;
  double strength_ = 0;  // of the lights along it; 0: they are not sampled along it
};

}  // namespace lanthorn
