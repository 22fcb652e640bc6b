// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/voxelcones/voxel_grids.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lanthorn {

int voxel_grid_limit(int size) {
  // Six directions of four half floats, and an eighth more for each coarser level.
  constexpr std::int64_t most_bytes = std::int64_t{2} << 30, bytes_of_voxel = 6 * 8;
  const std::int64_t voxels = std::int64_t{size} * size * size, bytes = voxels * bytes_of_voxel * 8 / 7;
  return static_cast<int>(std::clamp<std::int64_t>(most_bytes / bytes, 1, gpu::most_voxel_grids));
}

std::vector<VoxelGrid> voxel_grids(const Bounds& bounds, int size, const ViewFocus& focus, int count) {
  constexpr float width_by_distance = 1.5f;
  constexpr int steps = 8;  // of a corner along the grid's edge
  // Centres the surfaces in the grid, so that the outermost walls lie in the middles of voxels.
  VoxelGrid whole;
  whole.size = size;
  const float widest = bounds.empty() ? 0 : max_component(bounds.extent());
  whole.side = widest > 0 && widest < infinity ? widest / static_cast<float>(size - 3) : 1;
  whole.corner = (bounds.empty() ? Point(0) : bounds.centre()) - 0.5f * whole.edge();
  std::vector<VoxelGrid> grids{whole};
  const int limit = count > 0 ? std::min(count, voxel_grid_limit(size)) : voxel_grid_limit(size);
  while (static_cast<int>(grids.size()) < limit) {
    VoxelGrid next = grids.back();
    next.side *= 0.5f;
    if (count == 0 && !(next.edge() >= width_by_distance * focus.distance)) break;
    const float step = next.edge() / steps;
    for (int axis = 0; axis < 3; ++axis) {
      const float wanted = (focus.centre[axis] - 0.5f * next.edge() - whole.corner[axis]) / step;
      const float last = (whole.edge() - next.edge()) / step;
      next.corner[axis] = whole.corner[axis] + step * std::clamp(std::round(wanted), 0.0f, last);
    }
    grids.push_back(next);
  }
  return grids;
}

}  // namespace lanthorn
