// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "integrators/photonmap/two_pass.h"
#include "path/render_job.h"

namespace lanthorn {

/// From the parameters whose names begin with "cache-".
GatherCacheSettings gather_cache_settings(const Parameters& parameters);

/// Fills the caches of final gathering in `maps` (irradiance caching, Ward et al. 1988), for the diffuse surfaces that
/// the eye paths of this pass see directly or through mirrors and clear glass. Works in stages over finer and finer
/// grids of pixels. In each stage, pixels without a valid record from earlier stages gather in parallel; then the new
/// records are added in pixel order. The records do not depend on the number of threads.
void fill_gather_caches(const RenderJob& job, const TwoPassSettings& settings, std::uint32_t pass, TwoPassMaps& maps);

}  // namespace lanthorn
