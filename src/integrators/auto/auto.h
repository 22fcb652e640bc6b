// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "integrators/vcm/vcm_pass.h"

namespace lanthorn {

/// The effort with the least product of variance and work, which a pilot finds (see `EffortPlanner`): a function of the
/// job alone.
void plan_effort(const RenderJob& job, const VcmSettings& settings, VcmPreparation& prepared);

}  // namespace lanthorn
