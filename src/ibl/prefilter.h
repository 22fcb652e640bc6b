// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The prefiltered environment of split-sum shading (Karis 2013, "Real Shading in Unreal Engine 4"): the environment seen
// through the lobe of a rough mirror at n = v = r.
#pragma once

#include <span>

#include "ibl/cube_map.h"
#include "ibl/environment.h"

namespace lanthorn {

/// Weight of light by the angle to the normal: D(h) / 4 · n·l, with GGX's D and n = v, so that n·h = v·h = cos of half
/// that angle and the density of reflected directions is D / 4. Its integral over directions is 1.
class GgxKernel {
 public:
  explicit GgxKernel(float alpha);
  float operator()(float cos, float distance2) const {
    // sin² of half the angle is distance² / 4.
    const float sin2 = 0.25f * distance2, e = sin2 + alpha2_ * (1 - sin2);
    return cos > 0 ? scale_ * cos / (e * e) : 0.0f;
  }

 private:
  float alpha2_, scale_;
};

/// Mirrors at a level of the map: the environment without its suns, averaged over each texel, and the suns.
CubeMap mirror_level(const CubePyramid& source, const Environment& environment, int size);

/// Rough mirrors of this alpha, by filtered importance sampling (Křivánek & Colbert 2008): `samples` visible normals,
/// each a look-up in the level of `source` whose texels have the solid angle of the sample. Suns are added exactly.
CubeMap prefilter(const CubePyramid& source, const Environment& environment, float alpha, int size, int samples);

}  // namespace lanthorn
