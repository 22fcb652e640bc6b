// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Numbers and structs that the C++ and the shaders of the split sum share.
#pragma once

#include "realtime/scene/layouts.h"

namespace lanthorn::gpu {

#include "realtime/techniques/splitsum/splitsum_constants.glsl"

}  // namespace lanthorn::gpu
