// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "integrators/auto/measurement.h"
#include "integrators/vcm/vcm_settings.h"
#include "path/render_job.h"

namespace lanthorn {

struct VcmPreparation;

/// The light paths of each of the pilot's passes.
std::uint64_t pilot_light_paths(const RenderJob& job);

/// Variance and work of all candidates, by a pilot of a few passes over a grid of pixels: a function of the job alone.
/// `prepared`: emission, radii and an effort of `pilot_light_paths`.
EffortMeasurement measure_candidates(const RenderJob& job, const VcmSettings& settings, const VcmPreparation& prepared);

}  // namespace lanthorn
