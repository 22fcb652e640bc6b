// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "scene/scene.h"

namespace lanthorn {

/// Counts, bounds, memory, lights and materials of a built scene, for `info` and `render --json`.
nlohmann::json describe_scene(const Scene& scene);

}  // namespace lanthorn
