// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A coarser level of the voxels: for each two voxels one behind the other along the axis, the nearer one in front of
// the farther one; then the mean of four such pairs (Crassin et al. 2011, section 4.2).
#include "constants.glsl"
#include "layouts.glsl"
#include "voxelcones_constants.glsl"
layout(local_size_x = voxel_block, local_size_y = voxel_block, local_size_z = voxel_block) in;
layout(binding = unit_voxels) uniform sampler3D voxel_radiance;
layout(binding = image_of_technique, rgba16f) uniform writeonly image3D coarse;
uniform int level;  // of `coarse`

void main() {
  ivec3 own = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(own, imageSize(coarse)))) return;
  int size = imageSize(coarse).y;
  int k = own.z / size, axis = k >> 1;
  ivec3 along = ivec3(axis == 0, axis == 1, axis == 2), u = along.yzx, v = along.zxy;
  // Blocks of the finer level begin at twice the places of this one's.
  ivec3 near = 2 * own + ((k & 1) == 0 ? along : ivec3(0)), far = 2 * own + ((k & 1) == 0 ? ivec3(0) : along);
  vec4 sum = vec4(0);
  for (int i = 0; i < 4; ++i) {
    ivec3 beside = (i & 1) * u + (i >> 1) * v;
    vec4 front = texelFetch(voxel_radiance, near + beside, level - 1);
    sum += 0.25 * (front + (1 - front.a) * texelFetch(voxel_radiance, far + beside, level - 1));
  }
  imageStore(coarse, own, sum);
}
