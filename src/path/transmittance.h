// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/hash.h"
#include "path/walk.h"
#include "scene/scene.h"

namespace lanthorn {

/// Fraction of light that gets from the ray's origin, in `medium`, to its end: 0 behind a surface, else, in the mean,
/// what the media on the way leave. `rng` decides where media are not homogeneous.
Spectrum transmittance(const Scene& scene, const Ray& ray, MediumId medium, const Wavelengths& w, HashRng rng,
                       RayCounts& counts);

}  // namespace lanthorn
