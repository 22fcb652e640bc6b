// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How bright lights are, and where: what the light BVH and the film's scale are made from.
#pragma once

#include "light/emitter_sample.h"
#include "light/light_texels.h"
#include "math/vec.h"
#include "spectrum/curve.h"

namespace lanthorn {

/// Where the light of a light begins, which way it goes, and how much it is.
struct EmissionBounds {
  Bounds box;              ///< around all points of the light
  NormalCone cone;         ///< around all its normals, or the axis of what it emits
  float cos_emission = 1;  ///< of the largest angle to a normal under which it emits
  float intensity = 0;     ///< luminous power per solid angle, about
  bool two_sided = false;
};

/// The largest value in the visible range, or of the channels of RGB mode.
float largest_value(const SpectrumCurve& curve);
/// The same of all texels, under the illuminant.
float largest_value(const LightTexels& texels);

}  // namespace lanthorn
