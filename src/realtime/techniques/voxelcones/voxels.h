// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The surfaces of a scene in grids of voxels, by the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "lanthorn/vec.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/techniques/voxelcones/voxel_grids.h"
#include "scene/scene.h"

namespace lanthorn {

/// The surfaces in a voxel of which a side faces along one of the axes more than along the others; the layout of
/// voxel_sides.glsl. Each surface has two sides.
struct VoxelSide {
  Point position{0};    ///< mean over the surfaces
  float area = 0;       ///< m²
  glm::vec4 normal{0};  ///< mean, unit, away from this side; a: number of the voxel's grid
  glm::vec4 albedo{0};
  glm::vec4 through{0};  ///< transmittance, of light from the other side
};

/// A voxel that holds surfaces.
struct VoxelLeaf {
  std::uint32_t x = 0, y = 0, z = 0;
  std::uint32_t first_side = 0, side_count = 0;
  std::uint32_t grid = 0;  ///< number of its grid
  std::uint32_t unused[2] = {};
};

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

/// Of the surfaces in world space.
Bounds bounds_of(const GpuScene& gpu_scene, const GpuTriangles& triangles);

/// What of the triangles lies in the grid, cut by its voxels. Clear glass is left out. All materials count as diffuse
/// with their albedo at normal incidence; textures by the middle of each piece.
Voxels voxelise(const Scene& scene, const GpuScene& gpu_scene, const GpuTriangles& triangles, const VoxelGrid& grid);

}  // namespace lanthorn
