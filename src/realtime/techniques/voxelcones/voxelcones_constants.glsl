// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Numbers and structs that C++ and shaders share. This text is valid in both languages, after scene/layouts.glsl.
const int unit_voxels = unit_of_technique;
const int storage_sides = storage_of_technique;
const int storage_side_radiance = storage_of_technique + 1;
const int storage_leaves = storage_of_technique + 2;

const int most_voxel_grids = 8;
const int voxel_block = 4;  // threads of a group of voxel_mips.comp.glsl along each axis

// The surfaces in a voxel that have a side facing along this axis more than along the others. Each surface has two
// sides.
struct VoxelSide {
  vec3 position;  // mean over the surfaces
  float area;     // m²
  vec4 normal;    // mean, unit, away from this side; a: number of the voxel's grid
  vec4 albedo;
  vec4 through;  // transmittance, of light from the other side
};

// A voxel that holds surfaces.
struct VoxelLeaf {
  uint x, y, z;  // in its grid
  uint first_side;
  uint side_count;
  uint grid;  // number of its grid
  uint unused_1, unused_2;
};
