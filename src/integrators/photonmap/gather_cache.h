// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "integrators/photonmap/irradiance_cache.h"
#include "integrators/photonmap/two_pass.h"
#include "path/eye_pass.h"
#include "path/render_job.h"

namespace lanthorn {

/// From the parameters whose names begin with "cache-".
GatherCacheSettings gather_cache_settings(const Parameters& parameters);

/// Fills the caches of final gathering in `maps` (irradiance caching, Ward et al. 1988), for the diffuse surfaces that
/// the eye paths of this pass see directly or through mirrors and clear glass. Works in stages over finer and finer
/// grids of pixels. In each stage, pixels without a valid record from earlier stages gather in parallel; then the new
/// records are added in pixel order. The records do not depend on the number of threads.
void fill_gather_caches(const RenderJob& job, const TwoPassSettings& settings, std::uint32_t pass, TwoPassMaps& maps);

/// What all pixels of a pass share when they make records: a record is the point where a pixel's eye path looks up
/// irradiance, and what the gather rays from there have found (gather_record.cpp).
struct GatherFill {
  const RenderJob& job;
  const TwoPassSettings& settings;
  const TwoPassMaps& maps;
  HemisphereGrid grid;
  std::uint32_t pass;
  std::atomic<std::uint64_t>& misses;  ///< unused counter: gather rays do not look up the cache
};

/// The point at which a pixel will look up irradiance.
struct SeenPoint {
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  Point position{0};
  Normal normal{0, 0, 1};
  float pixel = 0;           ///< width of a pixel at the point, m
  std::size_t cache = none;  ///< index among the pass's caches
};
SeenPoint seen_from(const GatherFill& fill, const PixelPlace& place, RayCounts& counts);

/// A record whose irradiance has not been gathered yet. Its radius is the shortest spacing.
IrradianceRecord planned_record(const SeenPoint& seen, const GatherCacheSettings& settings);
/// Follows the pixel's eye path to the point `seen` and gathers the record there.
IrradianceRecord make_record(const GatherFill& fill, const PixelPlace& place, const SeenPoint& seen, RayCounts& counts);

}  // namespace lanthorn
