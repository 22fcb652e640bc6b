// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Indirect light from the voxels on visible surfaces: diffuse cones, and one along the reflection.
#include "shade.glsl"
#include "split_terms.glsl"
#include "environment.glsl"
#include "voxels.glsl"
uniform float turn;
uniform float least_sky_alpha;  // GGX width from which views of lights show the environment

// The lobe of GGX as a cone in which its density is everywhere that of its peak, 1 / (4 pi alpha²): its solid angle
// 2 pi (1 - cos) is the inverse.
float lobe_tangent(float alpha) {
  float c = max(0.5, 1 - 2 * alpha * alpha);
  return sqrt(1 - c * c) / c;
}

vec3 shade(ivec2 pixel, Surface at, vec3 wi) {
  if (is_drawn_by_paths(at.material)) return vec3(0);
  vec3 n = facing_normal(at, wi);
  float cos_i = dot(wi, n);
  SplitTerms terms = split_terms(at, cos_i);
  vec3 sum = vec3(0);
  if (terms.diffuse != vec3(0)) sum = terms.diffuse * diffuse_cones(at.position, n, turn, grid_count - 1);
  if (terms.diffuse_behind != vec3(0))
    sum += terms.diffuse_behind * diffuse_cones(at.position, -n, turn, grid_count - 1);
  if (terms.f0 == vec3(0) && terms.f90 == vec3(0)) return sum;
  vec3 reflected = 2 * cos_i * n - wi;
  int grid = grid_of_cones(at.position, turn, grid_count - 1);
  vec4 cone = trace_cone(at.position, n, reflected, lobe_tangent(terms.alpha), grid);
  if ((at.material.flags & flag_smooth) != 0u)
    cone.rgb += (1 - cone.a) * environment_towards(reflected);
  else if (terms.alpha < least_sky_alpha)
    cone.rgb += (1 - cone.a) * environment_in_cone(reflected, lobe_tangent(terms.alpha));
  vec2 albedo = albedo_terms(cos_i * plastic_cosines, terms.alpha);
  return sum + (terms.f0 * albedo.x + terms.f90 * albedo.y) * cone.rgb;
}
