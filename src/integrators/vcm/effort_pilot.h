// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "integrators/vcm/effort.h"
#include "integrators/vcm/moments.h"
#include "integrators/vcm/vcm_settings.h"
#include "path/render_job.h"

namespace lanthorn {

struct VcmPreparation;

/// The light paths of each of the pilot's passes.
std::uint64_t pilot_light_paths(const RenderJob& job);

/// What the pilot expects of a choice that holds everywhere.
struct CandidateEstimate {
  EffortCandidate candidate;  ///< light paths as multiples of those of the render's settings
  double variance = 0;        ///< of a pass: the mean over pixels, of the sum of the components of radiance
  double work = 0;            ///< of a pass, for each pixel, in rays
};
std::vector<CandidateEstimate> estimate_candidates(const RenderJob& job, const VcmSettings& settings,
                                                   const VcmPreparation& prepared);

/// The effort with the least product of variance and work, by a pilot of a few passes over a grid of pixels: a function
/// of the job alone. `prepared`: emission, radii and an effort of `pilot_light_paths`.
Effort measure_effort(const RenderJob& job, const VcmSettings& settings, const VcmPreparation& prepared);

}  // namespace lanthorn
