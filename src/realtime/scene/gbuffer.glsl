// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The textures of a G-buffer (realtime/scene/gbuffer.h), seen from the eye, and the place of the eye.
#include "bsdf.glsl"
layout(binding = unit_g_position) uniform sampler2D g_position;  // world; a: depth along the axis, m; 0: nothing
layout(binding = unit_g_surface) uniform usampler2D g_surface;  // shading normal, geometric normal, material, triangle
layout(binding = unit_g_colour) uniform sampler2D g_colour;    // reflectance, GGX width
layout(binding = unit_g_lobe) uniform sampler2D g_lobe;     // Surface::lobe

bool is_background(ivec2 pixel) { return texelFetch(g_position, pixel, 0).a == 0; }
Surface surface_at(ivec2 pixel) {
  uvec4 packed_surface = texelFetch(g_surface, pixel, 0);
  return Surface(texelFetch(g_position, pixel, 0).xyz, decode_octahedral(packed_surface.x),
                 decode_octahedral(packed_surface.y), texelFetch(g_colour, pixel, 0), texelFetch(g_lobe, pixel, 0),
                 materials[packed_surface.z], packed_surface.w);
}

// Where a frame is seen from.
uniform vec3 eye;
uniform vec4 axis;  // of the view; a: 1 if its rays are parallel

vec3 direction_to_eye(vec3 position) { return axis.a > 0 ? -axis.xyz : normalize(eye - position); }
