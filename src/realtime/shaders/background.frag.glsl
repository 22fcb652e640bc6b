// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The environment where no surface is.
#include "octahedral.glsl"
layout(binding = 2) uniform sampler2D environment;  // equirectangular around +y
layout(binding = 4) uniform sampler2D g_position;
uniform vec3 corner, right, down;  // of the window: points at distance 1 along the axis, or the direction of all rays
uniform vec2 size;
layout(location = 0) out vec4 radiance;

void main() {
  if (texelFetch(g_position, ivec2(gl_FragCoord.xy), 0).a != 0) discard;
  vec2 place = gl_FragCoord.xy / size;
  vec3 d = normalize(corner + place.x * right + place.y * down);
  const float pi = 3.14159265358979;
  vec2 at = vec2(atan(d.z, d.x) / (2 * pi) + 0.5, acos(clamp(d.y, -1, 1)) / pi);
  radiance = vec4(texelFetch(environment, min(ivec2(at * textureSize(environment, 0)), textureSize(environment, 0) - 1), 0).rgb, 1);
}
