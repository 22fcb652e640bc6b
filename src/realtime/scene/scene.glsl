// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The scene's buffers.
#include "constants.glsl"
#include "layouts.glsl"
layout(std430, binding = storage_vertices) readonly buffer Vertices { Vertex vertices[]; };
layout(std430, binding = storage_indices) readonly buffer Indices { uint indices[]; };
layout(std430, binding = storage_draws) readonly buffer Draws { Draw draws[]; };
