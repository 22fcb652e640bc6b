// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "integrators/photonmap/two_pass.h"
#include "path/render_job.h"

namespace lanthorn {

/// From the parameters whose names begin with "cache-".
GatherCacheSettings gather_cache_settings(const Parameters& parameters);

/// Fills the caches of final gathering in `maps` (irradiance caching, Ward et al. 1988): for the points that the eye
/// paths of this pass see on diffuse surfaces, directly or through mirrors and clear glass. In stages over finer and
/// finer grids of pixels: the pixels of a stage, in parallel, gather where no record of earlier stages is near enough;
/// then, in their order, the new records are added. So records do not depend on the number of threads.
void fill_gather_caches(const RenderJob& job, const TwoPassSettings& settings, std::uint32_t pass, TwoPassMaps& maps);

}  // namespace lanthorn
