// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "realtime/techniques/technique.h"

namespace lanthorn {

/// The techniques that techniques/CMakeLists.txt lists.
std::vector<TechniqueInfo> built_in_techniques();

}  // namespace lanthorn
