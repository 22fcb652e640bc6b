// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Finest level of the voxels: the light that their surfaces send along the axes, weighted by the areas that they show
// there.
#include "voxel_sides.glsl"
layout(local_size_x = work_group) in;
layout(binding = image_of_technique, rgba16f) uniform writeonly image3D voxels;
uniform int leaf_count;
uniform float coarsest_side;  // edge of a voxel of grid 0, m
const float largest = 60000;  // near the largest half float

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= leaf_count) return;
  VoxelLeaf leaf = leaves[i];
  int size = imageSize(voxels).y;
  float voxel_side = ldexp(coarsest_side, -int(leaf.grid));
  ivec3 place = ivec3(leaf.x, leaf.y, leaf.z) + ivec3(int(leaf.grid) * size, 0, 0);
  for (int k = 0; k < 6; ++k) {
    vec4 sum = vec4(0);
    for (uint s = leaf.first_side; s < leaf.first_side + leaf.side_count; ++s) {
      float along = (k & 1) == 0 ? sides[s].normal[k >> 1] : -sides[s].normal[k >> 1];
      sum += max(along, 0) * sides[s].area * vec4(side_radiance[s].rgb, 1);
    }
    float covered = min(1, sum.a / (voxel_side * voxel_side));
    vec3 radiance = sum.a > 0 ? min(sum.rgb / sum.a, vec3(largest)) : vec3(0);
    imageStore(voxels, place + ivec3(0, 0, k * size), vec4(covered * radiance, covered));
  }
}
