// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// (1/pi) times the integral of L cos, for each texel of a map of one level, as ibl/bake.cpp.
#include "cube_map.glsl"
#include "points.glsl"
layout(local_size_x = work_group) in;
layout(binding = image_of_technique, rgba32f) uniform writeonly image2D map;
uniform int first_size;

void main() {
  if (gl_GlobalInvocationID.x >= uint(6 * first_size * first_size)) return;
  CubeTexel own = own_texel(gl_GlobalInvocationID.x, first_size);
  vec3 n = direction_of_texel(own, first_size);
  vec4 sum = vec4(0);
  for (int i = 0; i < point_count; ++i) {
    vec3 between = n - points[i].direction.xyz;
    sum += max(1 - 0.5 * dot(between, between), 0) * points[i].flux;
  }
  imageStore(map, place_of_texel(own, first_size, 0), vec4(sum.rgb / sum.a, 0));
}
