// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The surfaces of a scene in voxels, by the CPU. The voxels lie in nested grids around the eye, a clipmap.
#pragma once

#include <cstdint>
#include <vector>

#include "lanthorn/vec.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/scene/layouts.h"
#include "realtime/scene/projection.h"
#include "scene/scene.h"

namespace lanthorn {

namespace gpu {
#include "realtime/techniques/voxelcones/voxelcones_constants.glsl"
}  // namespace gpu

inline constexpr int least_voxels = 16, most_voxels = 256;

/// A cube of size³ voxels.
struct VoxelGrid {
  int size = 0;  ///< a power of two
  Point corner{0};
  float side = 1;  ///< edge of a voxel, m

  float edge() const { return side * static_cast<float>(size); }
  friend bool operator==(const VoxelGrid&, const VoxelGrid&) = default;
};

/// Largest number of grids of this size: `gpu::most_voxel_grids`, or fewer if they would not fit into 2 GiB of memory.
int voxel_grid_limit(int size);

/// A cube around `bounds`, followed by cubes around the focus, each with half the edge of the one before and moved so
/// that it lies inside the first. `count` of them in all; if 0, until the next one would be less than 1.5 times as wide
/// as the focus is distant. Their corners move by eighths of their edges, so that most of them stay in place when the
/// focus moves.
std::vector<VoxelGrid> voxel_grids(const Bounds& bounds, int size, const ViewFocus& focus, int count);

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
