// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "lanthorn/scene.h"

namespace lanthorn::program {

/// Summary for `info --json` and for reports of renders.
nlohmann::json scene_report(const SceneSummary& scene);

}  // namespace lanthorn::program
