// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "integrators/vcm/effort.h"
#include "integrators/vcm/effort_measurement.h"
#include "path/render_job.h"

namespace lanthorn {

/// The effort with the least product of variance and work: a function of the job alone.
Effort choose_effort(const RenderJob& job, const EffortMeasurement& measured);

/// What the pilot expects of a choice that holds everywhere.
struct CandidateEstimate {
  EffortCandidate candidate;  ///< light paths as multiples of those of the render's settings
  double variance = 0;        ///< of a pass: the mean over pixels, of the sum of the components of radiance
  double work = 0;            ///< of a pass, for each pixel, in rays
};
std::vector<CandidateEstimate> estimate_candidates(const RenderJob& job, const EffortMeasurement& measured);

}  // namespace lanthorn
