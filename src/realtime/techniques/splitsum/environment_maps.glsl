// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Look-ups of split-sum shading (ibl/split_sum.h), with the same arithmetic.
#include "constants.glsl"
#include "layouts.glsl"
#include "splitsum_constants.glsl"
#include "cube_map.glsl"
layout(binding = unit_reflections) uniform sampler2D reflections;
layout(binding = unit_irradiances) uniform sampler2D irradiances;
layout(binding = unit_brdf_terms) uniform sampler2D brdf_terms;
uniform int level_count;
uniform int first_size;
uniform int irradiance_size;

vec3 irradiance_towards(vec3 n) { return cube_lookup(irradiances, irradiance_size, 0, n); }
vec3 reflection_towards(vec3 r, float alpha) {
  float last = level_count - 1, level = clamp(sqrt(alpha) * last, 0, last);
  int lower = int(level), upper = min(lower + 1, level_count - 1);
  return mix(cube_lookup(reflections, first_size, lower, r), cube_lookup(reflections, first_size, upper, r),
             level - lower);
}
vec2 brdf_of(float cos_i, float alpha) {
  int size = textureSize(brdf_terms, 0).x;
  vec2 place = clamp(vec2(cos_i, sqrt(alpha)) * size - 0.5, vec2(0), vec2(size - 1));
  ivec2 low = min(ivec2(place), ivec2(size - 2));
  vec2 f = place - vec2(low);
  vec2 above = mix(texelFetch(brdf_terms, low, 0).xy, texelFetch(brdf_terms, low + ivec2(1, 0), 0).xy, f.x);
  vec2 below = mix(texelFetch(brdf_terms, low + ivec2(0, 1), 0).xy, texelFetch(brdf_terms, low + ivec2(1), 0).xy, f.x);
  return mix(above, below, f.y);
}
