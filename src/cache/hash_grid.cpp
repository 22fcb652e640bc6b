// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "cache/hash_grid.h"

#include <algorithm>
#include <bit>
#include <vector>

#include "base/parallel.h"
#include "cache/bounds_of.h"
#include "cache/counting_sort.h"

namespace lanthorn {

namespace {

/// Table entries per point up to which every cell has its own.
constexpr std::size_t dense_entries_per_point = 2;
constexpr float max_cells_per_axis = 0x1p19f;

}  // namespace

void HashGrid::choose_cells(const Bounds& bounds, std::size_t count) {
  if (bounds.empty()) return;
  origin_ = bounds.min;
  std::uint64_t product = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = bounds.extent()[axis];
    // A ball is as wide as a cell (half of one along x, where finer cells cost no extra look-ups).
    const float wanted = axis == 0 ? radius_ : 2 * radius_;
    const float size = std::max({wanted, extent / max_cells_per_axis, 1e-18f});
    per_cell_[axis] = 1.0f / size;
    cells_[static_cast<unsigned>(axis)] = static_cast<std::uint32_t>(extent * per_cell_[axis]) + 1;
    product *= cells_[static_cast<unsigned>(axis)];
  }
  hashed_ = product > dense_entries_per_point * count;
  const std::size_t runs = std::bit_ceil((count + run - 1) / run);
  run_mask_ = runs - 1;
  table_size_ = hashed_ ? runs * run : static_cast<std::size_t>(product);
}

IndexBuild<HashGrid> HashGrid::build(std::span<const Point> points, float radius) {
  HashGrid grid;
  grid.radius_ = radius;
  grid.table_size_ = 1;
  grid.choose_cells(bounds_of(points), points.size());
  KeyGroups groups =
      counting_sort(points.size(), grid.table_size_, [&](std::size_t i) { return grid.table_entry(points[i]); });
  grid.start_ = std::move(groups.start);
  grid.points_ = SlotPoints(points.size());
  parallel_chunks(points.size(), 1u << 14, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) grid.points_.set(slot, points[groups.order[slot]]);
  });
  return {std::move(grid), std::move(groups.order)};
}

}  // namespace lanthorn
