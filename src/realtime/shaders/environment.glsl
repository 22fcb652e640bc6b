// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The environment as it is seen.
#include "pi.glsl"
layout(binding = 2) uniform sampler2D environment;  // equirectangular around +y

vec3 environment_towards(vec3 d) {
  vec2 at = vec2(atan(d.z, d.x) / (2 * pi) + 0.5, acos(clamp(d.y, -1, 1)) / pi);
  return texelFetch(environment, min(ivec2(at * textureSize(environment, 0)), textureSize(environment, 0) - 1), 0).rgb;
}
