// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A constant instead of indirect light.
#include "gbuffer.glsl"
uniform vec3 ambient;  // irradiance, W/m²
layout(location = 0) out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  radiance = vec4(0, 0, 0, 1);
  if (is_background(pixel)) return;
  radiance.rgb = surface_at(pixel).colour.rgb / pi * ambient;
}
