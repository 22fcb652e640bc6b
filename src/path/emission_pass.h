// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What methods that find scattered light by splats leave to eye paths.
#pragma once

#include "film/film.h"
#include "path/ray_counts.h"
#include "path/render_job.h"

namespace lanthorn {

/// Which light eye paths add, besides volumetric emission in sight.
struct EyeShare {
  int scatterings = 0;          ///< emission seen after at most this many delta scatterings, and after nothing else
  bool all_volumetric = false;  ///< volumetric emission after any scatterings
};

/// Adds one sample to each pixel: this light, and albedo, normal and depth.
RayCounts see_emission(const RenderJob& job, const EyeShare& share, std::uint32_t pass, Film& film);

}  // namespace lanthorn
