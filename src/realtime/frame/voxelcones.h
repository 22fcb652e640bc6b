// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "integrators/integrator.h"

namespace lanthorn {

IntegratorInfo voxelcones_info();

}  // namespace lanthorn
