// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The surfaces of a scene in grids of voxels, by the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "lanthorn/vec.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/techniques/voxelcones/voxel_grids.h"
#include "realtime/techniques/voxelcones/voxelcones_constants.h"
#include "scene/scene.h"

namespace lanthorn {

using gpu::VoxelLeaf;
using gpu::VoxelSide;

struct Voxels {
  VoxelGrid grid;
  std::vector<VoxelSide> sides;
  std::vector<VoxelLeaf> leaves;
};

/// Corners and indices of the GPU's triangles, read back.
struct GpuTriangles {
  explicit GpuTriangles(const GpuScene& scene) : vertices(scene.read_vertices()), indices(scene.read_indices()) {}

  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// Bounds of the surfaces in world space.
Bounds bounds_of(const GpuScene& gpu_scene, const GpuTriangles& triangles);

/// The parts of the triangles that lie in the grid, cut by its voxels. Clear glass is left out. All materials count as
/// diffuse with their albedo at normal incidence; textures are evaluated at the middle of each piece.
Voxels voxelise(const Scene& scene, const GpuScene& gpu_scene, const GpuTriangles& triangles, const VoxelGrid& grid);

}  // namespace lanthorn
