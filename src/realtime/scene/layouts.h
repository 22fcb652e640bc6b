// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Numbers, and structs in buffers, that C++ and shaders share.
#pragma once

#include <cstddef>
#include <cstdint>

#include "math/vec.h"

namespace lanthorn::gpu {

// NOLINTBEGIN(readability-identifier-naming): the names of GLSL
using uint = std::uint32_t;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using uvec4 = glm::uvec4;
using mat4 = glm::mat4;
// NOLINTEND(readability-identifier-naming)
// layouts.glsl uses numbers of constants.glsl.
#include "realtime/scene/constants.glsl"
#include "realtime/scene/layouts.glsl"

// GLSL's layout std430 lets a vector begin at multiples of 16 bytes. C++ would not leave a gap there.
static_assert(offsetof(Vertex, normal) == 16 && sizeof(Vertex) == 32);
static_assert(sizeof(Material) == 64);
static_assert(offsetof(Draw, emission) == 128 && sizeof(Draw) == 176);

inline bool operator==(const Material& a, const Material& b) {
  return a.colour == b.colour && a.through == b.through && a.specular == b.specular && a.kind == b.kind &&
         a.flags == b.flags && a.layer == b.layer;
}

}  // namespace lanthorn::gpu

namespace lanthorn {

using GpuVertex = gpu::Vertex;
using GpuMaterial = gpu::Material;
using GpuDraw = gpu::Draw;

}  // namespace lanthorn
