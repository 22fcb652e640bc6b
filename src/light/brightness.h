// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Position, orientation and brightness of lights, from which the light BVH is built and the film's scale is chosen.
#pragma once

#include "light/light_texels.h"
#include "light/sample.h"
#include "math/vec.h"
#include "spectrum/curve.h"

namespace lanthorn {

/// Bounds of a light's position and directions of emission, and its intensity.
struct EmissionBounds {
  Bounds box;              ///< around all points of the light
  NormalCone cone;         ///< contains all its normals; for lights without surface, a cone about the emission's axis
  float cos_emission = 1;  ///< cosine of the largest angle to a normal at which it emits
  float intensity = 0;     ///< W/sr towards the front, as luminance, approximately
  bool two_sided = false;
};

/// The largest value in the visible range, or of the channels of RGB mode.
float largest_value(const SpectrumCurve& curve);
/// The same over all texels, as RGB under the illuminant.
float largest_value(const LightTexels& texels);

}  // namespace lanthorn
