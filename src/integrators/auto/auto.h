// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "integrators/auto/pilot.h"
#include "integrators/vcm/effort.h"
#include "integrators/vcm/vcm_pass.h"
#include "lanthorn/effort_report.h"
#include "path/render_job.h"

namespace lanthorn {

struct EffortChoice {
  Effort effort;
  EffortReport report;
};
/// The effort with the least product of variance and work: a function of the job alone.
EffortChoice choose_effort(const RenderJob& job, const EffortMeasurement& measured);

/// The effort with the least product of variance and work, which a pilot finds (see `EffortPlanner`): a function of the
/// job alone.
void plan_effort(const RenderJob& job, const VcmSettings& settings, VcmPreparation& prepared);

}  // namespace lanthorn
