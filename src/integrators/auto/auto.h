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
/// The effort with the least product of variance and work, as measured: a function of the job alone (choice.cpp).
EffortChoice choose_effort(const RenderJob& job, const EffortMeasurement& measured);

/// Lets a pilot measure (`EffortPlanner`), and puts the effort that `choose_effort` then chooses into `prepared`.
void plan_effort(const RenderJob& job, const VcmSettings& settings, VcmPreparation& prepared);

}  // namespace lanthorn
