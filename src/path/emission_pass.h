// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What methods that find scattered light by splats leave to eye paths.
#pragma once

#include "film/film.h"
#include "path/ray_counts.h"
#include "path/render_settings.h"
#include "scene/scene.h"

namespace lanthorn {

/// Which light that is, besides that of media that glow in sight.
struct EyeShare {
  int scatterings = 0;  ///< emission after at most so many scatterings by mirrors and clear glass, and by nothing else
  bool all_glow = false;  ///< light of glowing media after any scatterings
};

/// Adds one sample to each pixel: this light, and albedo, normal and depth.
RayCounts see_emission(const Scene& scene, const RenderSettings& settings, const EyeShare& share, std::uint32_t pass,
                       Film& film);

}  // namespace lanthorn
