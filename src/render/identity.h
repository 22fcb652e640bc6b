// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lanthorn/scene_description.h"
#include "render/plan.h"

namespace lanthorn {

/// `RenderState::settings` for this render: its identity, and information for readers of the file.
std::string describe_render(const Scene& scene, const ViewDescription& view, const RenderPlan& plan);

}  // namespace lanthorn
