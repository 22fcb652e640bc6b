// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The environment as seen directly, and blurred.
#include "constants.glsl"
layout(binding = unit_environment) uniform sampler2D environment;  // equirectangular around +y

vec2 place_in_environment(vec3 d) { return vec2(atan(d.z, d.x) / (2 * pi) + 0.5, acos(clamp(d.y, -1, 1)) / pi); }

// The approximate mean over a cone.
vec3 environment_in_cone(vec3 d, float tan_half_angle) {
  float texels = 2 * tan_half_angle * textureSize(environment, 0).x / (2 * pi);
  return textureLod(environment, place_in_environment(d), log2(max(texels, 1))).rgb;
}

vec3 environment_towards(vec3 d) {
  vec2 at = place_in_environment(d);
  return texelFetch(environment, min(ivec2(at * textureSize(environment, 0)), textureSize(environment, 0) - 1), 0).rgb;
}
