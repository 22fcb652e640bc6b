// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lanthorn/render_record.h"
#include "lanthorn/scene_description.h"
#include "render/plan.h"

namespace lanthorn {

/// `RenderState::record` of this render before its preparation.
RenderRecord record_of(const Scene& scene, const ViewDescription& view, const RenderOptions& options,
                       const RenderPlan& plan);

}  // namespace lanthorn
