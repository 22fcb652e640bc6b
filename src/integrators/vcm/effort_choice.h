// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "integrators/vcm/effort.h"
#include "integrators/vcm/effort_measurement.h"
#include "path/render_job.h"

namespace lanthorn {

/// The effort with the least product of variance and work: a function of the job alone.
Effort choose_effort(const RenderJob& job, const EffortMeasurement& measured);

}  // namespace lanthorn
