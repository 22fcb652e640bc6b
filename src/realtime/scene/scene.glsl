// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The scene's buffers; the layouts are those of realtime/scene/gpu_scene.h.
#include "constants.glsl"
struct Draw {
  mat4 to_world;
  mat4 normal_to_world;
  vec4 emission;  // radiance; a: 1 if both sides emit
  uint material;
  uint first_index;
  uint base_vertex;
  float slack;
  uint index_count;
  uint layer;  // of the surface textures: emission as a share of `emission`, opacity
  uint mesh, first_light;
};
struct Vertex {
  vec4 position_u;
  vec4 normal_v;
};
layout(std430, binding = storage_vertices) readonly buffer Vertices { Vertex vertices[]; };
layout(std430, binding = storage_indices) readonly buffer Indices { uint indices[]; };
layout(std430, binding = storage_draws) readonly buffer Draws { Draw draws[]; };
