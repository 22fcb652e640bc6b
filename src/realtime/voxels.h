// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The surfaces of a scene in a grid of voxels, by the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "lanthorn/vec.h"
#include "realtime/gpu_scene.h"
#include "scene/scene.h"

namespace lanthorn {

/// The surfaces in a voxel of which a side faces along one of the axes more than along the others; the layout of
/// shaders/voxel_sides.glsl. Each surface has two sides.
struct VoxelSide {
  Point position{0};    ///< mean over the surfaces
  float area = 0;       ///< m²
  glm::vec4 normal{0};  ///< mean, unit, away from this side
  glm::vec4 albedo{0};
  glm::vec4 through{0};  ///< transmittance, of light from the other side
};

/// A voxel that holds surfaces.
struct VoxelLeaf {
  std::uint32_t x = 0, y = 0, z = 0;
  std::uint32_t first_side = 0, side_count = 0;
  std::uint32_t unused[3] = {};
};

struct Voxels {
  int size = 0;  ///< along an edge of the cube
  Point corner{0};
  float side = 1;  ///< edge of a voxel, m
  std::vector<VoxelSide> sides;
  std::vector<VoxelLeaf> leaves;
};

/// The triangles of the GPU, cut by the voxels of a cube around all of them. Clear glass is left out. All materials
/// count as diffuse with their albedo at normal incidence; textures by the middle of each piece.
Voxels voxelise(const Scene& scene, const GpuScene& gpu_scene, int size);

}  // namespace lanthorn
