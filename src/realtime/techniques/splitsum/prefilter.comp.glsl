// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The environment in rough mirrors, one level of the map, as ibl/prefilter.cpp: samples of the lobe, and the suns.
#include "cube_map.glsl"
#include "points.glsl"
#include "frame.glsl"
layout(local_size_x = work_group) in;
layout(std430, binding = storage_samples) readonly buffer Samples { LobeSample samples[]; };
layout(binding = unit_bake_source) uniform sampler2D source;
layout(binding = image_of_technique, rgba32f) uniform writeonly image2D map;
uniform int source_size;
uniform int first_size;
uniform int level;
uniform int sample_count;
uniform float alpha2;
uniform float kernel_scale;
uniform int weight;  // of light in the lobe: 0: n·l, 1: Smith's G2 / G1

float lobe_weight(float c) { return weight == 0 ? c : 2 * c / (c + sqrt(alpha2 * (1 - c * c) + c * c)); }
// sin² of half the angle is distance² / 4.
float kernel(float distance2) {
  float sin2 = 0.25 * distance2, e = sin2 + alpha2 * (1 - sin2), c = 1 - 0.5 * distance2;
  return c > 0 ? kernel_scale * lobe_weight(c) / (e * e) : 0;
}

void main() {
  int size = first_size >> level;
  if (gl_GlobalInvocationID.x >= uint(6 * size * size)) return;
  CubeTexel own = own_texel(gl_GlobalInvocationID.x, size);
  vec3 n = direction_of_texel(own, size);
  mat3 frame = frame_around(n);
  vec3 sum = vec3(0);
  for (int i = 0; i < sample_count; ++i)
    sum += samples[i].direction.a *
           cube_lookup(source, source_size, int(samples[i].level.x), frame * samples[i].direction.xyz);
  for (int i = 0; i < point_count; ++i) {
    vec3 between = n - points[i].direction.xyz;
    sum += kernel(dot(between, between)) * points[i].flux.rgb;
  }
  imageStore(map, place_of_texel(own, first_size, level), vec4(sum, 0));
}
