// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lanthorn/ibl.h"

namespace lanthorn {

/// Roughness of the level at x = level / last level; and the inverse.
float level_roughness(float x, RoughnessMapping mapping);
float level_of_roughness(float roughness, RoughnessMapping mapping);

}  // namespace lanthorn
