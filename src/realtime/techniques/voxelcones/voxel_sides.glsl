// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The surfaces in the voxels (realtime/techniques/voxelcones/voxels.h).
#include "constants.glsl"
#include "layouts.glsl"
#include "voxelcones_constants.glsl"
layout(std430, binding = storage_sides) readonly buffer Sides { VoxelSide sides[]; };
layout(std430, binding = storage_side_radiance) buffer SideRadiance { vec4 side_radiance[]; };
layout(std430, binding = storage_leaves) readonly buffer Leaves { VoxelLeaf leaves[]; };
