// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Split-sum shading by the maps of the environment (Karis 2013), as integrators/splitsum.cpp: no shadows.
#include "shade.glsl"
#include "split_terms.glsl"
#include "environment_maps.glsl"

vec3 shade(ivec2 pixel, Surface at, vec3 wi) {
  vec3 n = facing_normal(at, wi);
  float cos_i = dot(wi, n);
  SplitTerms terms = split_terms(at, cos_i);
  vec3 sum = terms.diffuse * irradiance_towards(n);
  if (terms.diffuse_behind != vec3(0)) sum += terms.diffuse_behind * irradiance_towards(-n);
  if (terms.f0 == vec3(0) && terms.f90 == vec3(0)) return sum;
  vec2 brdf = brdf_of(cos_i, terms.alpha);
  return sum + (terms.f0 * brdf.x + terms.f90 * brdf.y) * reflection_towards(2 * cos_i * n - wi, terms.alpha);
}
