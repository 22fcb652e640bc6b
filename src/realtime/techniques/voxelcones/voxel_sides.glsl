// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The surfaces in the voxels (realtime/techniques/voxelcones/voxels.h).
#include "constants.glsl"
#include "voxelcones_constants.glsl"
struct VoxelSide {
  vec4 position;  // mean; a: area, m²
  vec4 normal;    // a: number of the voxel's grid
  vec4 albedo;
  vec4 through;  // transmittance
};
struct VoxelLeaf {
  uvec4 place;  // of the voxel in its grid; a: first side
  uvec4 sides;  // x: number of them; y: number of the grid
};
layout(std430, binding = storage_sides) readonly buffer Sides { VoxelSide sides[]; };
layout(std430, binding = storage_side_radiance) buffer SideRadiance { vec4 side_radiance[]; };
layout(std430, binding = storage_leaves) readonly buffer Leaves { VoxelLeaf leaves[]; };
