// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Numbers that C++ and shaders share. This text is valid in both languages, after scene/constants.glsl.
const int unit_voxels = unit_of_technique;
const int storage_sides = storage_of_technique;
const int storage_side_radiance = storage_of_technique + 1;
const int storage_leaves = storage_of_technique + 2;

const int most_voxel_grids = 8;
const int voxel_block = 4;  // threads of a group of voxel_mips.comp.glsl along each axis
