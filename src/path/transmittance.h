// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/sample.h"
#include "math/hash.h"
#include "medium/medium.h"
#include "path/path_context.h"
#include "scene/scene.h"

namespace lanthorn {

/// Fraction of light that gets from the ray's origin, in `medium`, to its end: 0 behind a surface, else, in the mean,
/// what the media on the way leave. `rng` decides where media are not homogeneous.
Spectrum transmittance(const PathContext& path, const Ray& ray, MediumId medium, HashRng rng);

/// What becomes of light on its way.
struct Passage {
  Spectrum transmittance;
  MediumId medium = MediumId::vacuum;  ///< at the end of the way
};
/// Of a photon's light from infinitely far away, where it was in `medium`, to its origin.
Passage passage_from_infinity(const PathContext& path, const EmissionSample& emission, MediumId medium, float time,
                              HashRng rng);

}  // namespace lanthorn
