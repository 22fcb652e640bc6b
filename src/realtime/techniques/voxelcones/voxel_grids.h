// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Where the voxels of a scene lie: nested grids around the eye, a clipmap.
#pragma once

#include <vector>

#include "lanthorn/vec.h"
#include "realtime/scene/view_focus.h"
#include "realtime/techniques/voxelcones/voxelcones_constants.h"

namespace lanthorn {

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

}  // namespace lanthorn
