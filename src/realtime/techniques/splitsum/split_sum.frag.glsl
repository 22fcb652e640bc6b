// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Split-sum shading by the maps of the environment (Karis 2013), as integrators/splitsum.cpp: no shadows.
#include "gbuffer.glsl"
#include "eye.glsl"
#include "split_terms.glsl"
#include "environment_maps.glsl"
layout(location = 0) out vec4 radiance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  radiance = vec4(0, 0, 0, 1);
  if (is_background(pixel)) return;
  Surface at = surface_at(pixel);
  vec3 wi = direction_to_eye(at.position);
  vec3 n = dot(wi, at.normal) >= 0 ? at.normal : -at.normal;
  float cos_i = dot(wi, n);
  SplitTerms terms = split_terms(at, cos_i);
  radiance.rgb = terms.diffuse * irradiance_towards(n);
  if (terms.diffuse_behind != vec3(0)) radiance.rgb += terms.diffuse_behind * irradiance_towards(-n);
  if (terms.f0 == vec3(0) && terms.f90 == vec3(0)) return;
  vec2 brdf = brdf_of(cos_i, terms.alpha);
  radiance.rgb += (terms.f0 * brdf.x + terms.f90 * brdf.y) * reflection_towards(2 * cos_i * n - wi, terms.alpha);
}
