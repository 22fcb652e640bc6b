// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The prefiltered environment of split-sum shading (Karis 2013, "Real Shading in Unreal Engine 4"): the environment
// convolved with the lobe of a rough mirror at n = v = r.
#pragma once

#include <cmath>
#include <vector>

#include "ibl/cube_map.h"
#include "ibl/environment.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

/// Weight of light in the lobe besides its density, as a function of n·l.
inline float lobe_weight(LobeWeight weight, float alpha2, float cos) {
  if (weight == LobeWeight::cosine) return cos;
  return 2 * cos / (cos + std::sqrt(alpha2 * (1 - cos * cos) + cos * cos));
}

/// Weight of light by its angle to the normal: D(h) / 4 times the factor above, with GGX's D and n = v, so that n·h =
/// v·h = cos of half that angle, and the density of reflected directions is D / 4. Its integral over directions is 1.
class GgxKernel {
 public:
  GgxKernel(float alpha, LobeWeight weight);
  /// Normalisation that makes the integral 1.
  float scale() const { return scale_; }
  float operator()(float cos, float distance2) const {
    // sin² of half the angle is distance² / 4.
    const float sin2 = 0.25f * distance2, e = sin2 + alpha2_ * (1 - sin2);
    return cos > 0 ? scale_ * lobe_weight(weight_, alpha2_, cos) / (e * e) : 0.0f;
  }

 private:
  LobeWeight weight_;
  float alpha2_, scale_;
};

/// The mirror level of the map: the environment without its suns, averaged over each texel, plus the suns.
CubeMap mirror_level(const CubePyramid& source, const Environment& environment, int size);

struct Lobe {
  float alpha = 1;
  int samples = 1;
  LobeWeight weight = LobeWeight::cosine;
};

/// A direction of the lobe around +z, with its weight in the sum and the source level for its look-up.
struct LobeSample {
  Vec3 local{0, 0, 1};
  float weight = 0;
  int level = 0;
};
std::vector<LobeSample> sample_lobe(const Lobe& lobe, const CubePyramid& source);
/// Maximum spacing of sun points for a lobe, radians.
float sun_spacing(float alpha);

/// Rough mirrors, by filtered importance sampling (Křivánek & Colbert 2008): `samples` visible normals, each a look-up
/// in the level of `source` whose texels have the solid angle of the sample. Suns are added exactly.
CubeMap prefilter(const CubePyramid& source, const Environment& environment, const Lobe& lobe, int size);

}  // namespace lanthorn
