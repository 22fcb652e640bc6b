// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The environment in pixels that show no surface.
#include "environment.glsl"
layout(binding = unit_g_position) uniform sampler2D g_position;
uniform vec3 corner, right, down;  // of the window: points at distance 1 along the axis, or the direction of all rays
uniform vec2 size;
layout(location = 0) out vec4 radiance;

void main() {
  if (texelFetch(g_position, ivec2(gl_FragCoord.xy), 0).a != 0) discard;
  vec2 place = gl_FragCoord.xy / size;
  radiance = vec4(environment_towards(normalize(corner + place.x * right + place.y * down)), 1);
}
