// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The pass loop: one for all methods.
#pragma once

#include "lanthorn/session.h"
#include "lanthorn/statistics.h"
#include "render/plan.h"

namespace lanthorn {

/// Renders the passes of `stop.passes` that the plan's state has not done yet, in order, into that state. Prepares the
/// integrator first if it is not prepared. If the first pass is given up, the state has no passes.
RenderStatistics render(const Scene& scene, RenderPlan& plan, const StopRule& stop, const Observer& observer = {});

}  // namespace lanthorn
