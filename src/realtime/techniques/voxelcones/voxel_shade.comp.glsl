// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light that the surfaces in the voxels scatter: from the lights' views, and, after the first bounce, from other voxels
// by cones.
#include "shadow_maps.glsl"
#include "voxel_sides.glsl"
#include "voxels.glsl"
layout(local_size_x = work_group) in;
uniform int side_count;
uniform int view_count;
uniform bool has_shadows;
uniform bool has_cones;
uniform float turn;

// W/m² on the side of n, in a voxel of this edge.
vec3 irradiance_of_views(vec3 position, vec3 n, float voxel_side) {
  vec3 sum = vec3(0);
  for (int i = 0; i < view_count; ++i) {
    LightView v = views[i];
    vec3 way = v.origin.xyz - position;
    float distance_to_light = length(way);
    vec3 wo = v.origin.a == view_parallel ? v.axis.xyz : way / distance_to_light;
    float cosine = dot(wo, n);
    if (cosine <= 0) continue;
    vec3 light = v.colour.rgb * cosine;
    // Nearer than half a voxel, the mean position does not give the distance.
    float d = max(distance_to_light, 0.5 * voxel_side);
    if (v.origin.a != view_parallel) light *= falloff(v, -wo) / (d * d);
    if (light == vec3(0)) continue;
    if (has_shadows) light *= share_lit(i, position, n, no_triangle, wo, 0.5 * voxel_side);
    sum += light;
  }
  return sum;
}

vec3 irradiance_on(vec3 position, vec3 n, int grid) {
  vec3 sum = irradiance_of_views(position, n, side_of(grid));
  if (has_cones) sum += pi * diffuse_cones(position, n, turn, grid);
  return sum;
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= side_count) return;
  VoxelSide s = sides[i];
  int grid = int(s.normal.a);
  vec3 scattered = s.albedo.rgb * irradiance_on(s.position, s.normal.xyz, grid);
  if (s.through.rgb != vec3(0)) scattered += s.through.rgb * irradiance_on(s.position, -s.normal.xyz, grid);
  side_radiance[i] = vec4(scattered / pi, 0);
}
