// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Adds the light of a photon to the pixels in its volume.
#include "gbuffer.glsl"
#include "photon.glsl"
flat in vec3 photon_position, photon_normal, photon_power, photon_wi;
layout(location = 0) out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (is_background(pixel)) discard;
  Surface at = surface_at(pixel);
  if (is_drawn_by_paths(at.material)) discard;
  vec3 wi = direction_to_eye(at.position);
  radiance = vec4(photon_light(at, wi, Photon(photon_position, photon_normal, photon_power, photon_wi)), 0);
}
