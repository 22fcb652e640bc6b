// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "integrators/vcm/merge_map.h"
#include "integrators/vcm/vcm_settings.h"
#include "integrators/vcm/volume_merge.h"
#include "path/connections.h"
#include "path/light_vertices.h"
#include "path/render_job.h"
#include "photon/kernels.h"
#include "photon/pilot_radius.h"

namespace lanthorn {

/// What the visitors of a pass share.
struct VcmPass {
  const RenderJob& job;
  Bidirectional bidirectional;  ///< but its merging, which is each pixel's own
  VcmSwitches switches;
  std::optional<Strategy> only;  ///< all others are left out of the film
  const LightVertices& vertices;
  const std::vector<MergeMap>& merge_maps;           ///< by class (`FluxClasses`)
  const std::optional<VolumeMerges>& volume_merges;  ///< none if there are none in media
  float beam_share = 0;                              ///< of light paths whose flights are kept
  Kernel kernel;
  const FirstRadius& first_radius;
  PixelWindow radius_window;  ///< of `first_radius`
  float shrink = 1;           ///< of all radii since the first pass

  bool shows(const Strategy& strategy) const { return !only || *only == strategy; }
  /// Of all merges of eye paths through this place on the film with photons of a class.
  float radius_at(const Vec2& raster, int flux_class = 0) const {
    const std::uint32_t pixel = radius_window.pixel_at(raster);
    const float radius = first_radius.at(pixel) * shrink;
    return radius * first_radius.class_factor(flux_class, pixel, radius);
  }
  /// Paths through one place on the film are weighed with one radius, whatever technique made them: with
  /// η_VCM = N π r² (TR eq. 20).
  Bidirectional bidirectional_at(const Vec2& raster) const {
    Bidirectional result = bidirectional;
    if (switches.merging) result.techniques.merging = result.techniques.light_paths * pi * sqr(radius_at(raster));
    return result;
  }
};

}  // namespace lanthorn
