// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The eye paths of methods that find scattered light by splats: they add emission seen by the eye.
#pragma once

#include "film/film_pass.h"
#include "path/path_context.h"
#include "path/render_job.h"

namespace lanthorn {

/// The light that these eye paths add.
struct EyeShare {
  int scatterings = 0;          ///< emission seen after at most this many delta scatterings and no others
  bool unlit_emission = false;  ///< emission of media that are not lights, after any scatterings
};

/// Adds one sample to each pixel: the light that `share` names, and albedo, normal and depth.
RayCounts see_emission(const RenderJob& job, const EyeShare& share, std::uint32_t pass, const FilmPass& film);

}  // namespace lanthorn
