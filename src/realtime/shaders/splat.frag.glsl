// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Adds the light of a photon to the pixels in its volume.
#include "gbuffer.glsl"
#include "photon.glsl"
uniform vec3 eye;
uniform vec4 axis;
flat in uint photon;
layout(location = 0) out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (is_background(pixel)) discard;
  Surface at = surface_at(pixel);
  vec3 wi = axis.a > 0 ? -axis.xyz : normalize(eye - at.position);
  radiance = vec4(photon_light(at, wi, photons[photon]), 0);
}
