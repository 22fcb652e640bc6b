// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Numbers that C++ and shaders share.
#pragma once

#include <cstdint>

namespace lanthorn::gpu {

using uint = std::uint32_t;  // NOLINT(readability-identifier-naming): the name of GLSL
#include "realtime/scene/constants.glsl"

}  // namespace lanthorn::gpu
