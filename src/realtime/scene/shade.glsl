// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A shader that draws the light of what each pixel of the G-buffer shows. It defines `shade`.
#include "gbuffer.glsl"
layout(location = 0) out vec4 radiance;

// Radiance from a surface towards the eye. `wi`: direction to the eye.
vec3 shade(ivec2 pixel, Surface at, vec3 wi);

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  radiance = vec4(0, 0, 0, 1);
  if (is_background(pixel)) return;
  Surface at = surface_at(pixel);
  radiance.rgb = shade(pixel, at, direction_to_eye(at.position));
}
