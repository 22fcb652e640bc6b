// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "cache/point_index.h"
#include "cache/slot_points.h"
#include "math/vec.h"

namespace lanthorn {

/// Points sorted by the cell of a regular grid, for queries of one (largest) radius: progressive photon mapping, vertex
/// merging. Cells follow each other along x, so that the cells of one query that share y and z are one range of slots.
/// When the points' bounds hold too many cells for a table of all of them, runs of cells along x are hashed.
class HashGrid {
 public:
  /// Sorts the points for queries of radius <= `radius` (m, >= 0, finite). Points must be finite, fewer than 2^32.
  static IndexBuild<HashGrid> build(std::span<const Point> points, float radius);

  /// See `PointIndex`. `radius` must not exceed the one given to `build`.
  template <class Visit>
  void for_each_near(const Point& p, float radius, Visit&& visit) const {
    assert(radius <= radius_);
    const float reach = safe_reach(radius);
    const std::uint32_t x0 = cell(0, p.x - reach), x1 = cell(0, p.x + reach);
    const std::uint32_t y0 = cell(1, p.y - reach), y1 = cell(1, p.y + reach);
    const std::uint32_t z0 = cell(2, p.z - reach), z1 = cell(2, p.z + reach);
    const float limit = radius * radius;
    for (std::uint32_t z = z0; z <= z1; ++z)
      for (std::uint32_t y = y0; y <= y1; ++y) {
        if (!hashed_) {
          const std::uint32_t row = (z * cells_[1] + y) * cells_[0];
          points_.for_each_within(start_[row + x0], start_[row + x1 + 1], p, limit, visit);
        } else {
          visit_hashed_row(x0, x1, y, z, p, limit, visit);
        }
      }
  }

  std::size_t size() const { return points_.size(); }
  Point position(std::uint32_t slot) const { return points_[slot]; }
  /// Radius the grid was built for (m).
  float radius() const { return radius_; }
  /// Positions and cell table.
  std::size_t memory_bytes() const { return points_.memory_bytes() + table_bytes(); }
  /// Cell table alone.
  std::size_t table_bytes() const { return (table_size_ + 1) * sizeof(std::uint32_t); }

 private:
  /// Cells of a hashed run; the cells of one query along x lie in at most two runs.
  static constexpr std::uint32_t run = 8;

  /// Cell coordinate, clamped to the grid. Monotonic in x, and a difference followed by a product cannot be fused: so a
  /// point lies in a cell between those of two bounds of its coordinate, always.
  std::uint32_t cell(int axis, float x) const {
    const auto a = static_cast<unsigned>(axis);
    const float c = (x - origin_[axis]) * per_cell_[axis];
    return c > 0 ? std::min(static_cast<std::uint32_t>(std::min(c, 0x1p30f)), cells_[a] - 1) : 0;
  }
  /// First table entry of the run of cells that holds (x, y, z).
  std::uint32_t run_start(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    std::uint64_t h = (std::uint64_t{z} << 40) ^ (std::uint64_t{y} << 20) ^ (x / run);
    h = (h ^ (h >> 29)) * 0xbf58476d1ce4e5b9ull;
    h ^= h >> 32;
    return static_cast<std::uint32_t>(h & run_mask_) * run;
  }
  std::uint32_t table_entry(const Point& p) const {
    const std::uint32_t x = cell(0, p.x), y = cell(1, p.y), z = cell(2, p.z);
    return hashed_ ? run_start(x, y, z) + x % run : (z * cells_[1] + y) * cells_[0] + x;
  }

  /// Two rows of one query may share a run of the table: each visits only the points whose y and z are its own. (Runs
  /// of one row that coincide are read in disjoint parts.)
  template <class Visit>
  void visit_hashed_row(std::uint32_t x0, std::uint32_t x1, std::uint32_t y, std::uint32_t z, const Point& p,
                        float limit, Visit&& visit) const {
    const auto own = [&](std::uint32_t slot, float dist2) {
      const Point found = points_[slot];
      if (cell(1, found.y) == y && cell(2, found.z) == z) visit(slot, dist2);
    };
    for (std::uint32_t x = x0; x <= x1; x = (x / run + 1) * run) {
      const std::uint32_t base = run_start(x, y, z);
      const std::uint32_t last = std::min(x1, x / run * run + run - 1);
      points_.for_each_within(start_[base + x % run], start_[base + last % run + 1], p, limit, own);
    }
  }

  void choose_cells(const Bounds& bounds, std::size_t count);

  float radius_ = 0;
  Vec3 origin_{0};
  Vec3 per_cell_{0};  ///< cells per metre
  std::array<std::uint32_t, 3> cells_{1, 1, 1};
  bool hashed_ = false;
  std::uint64_t run_mask_ = 0;
  std::size_t table_size_ = 0;
  std::unique_ptr<std::uint32_t[]> start_;  ///< first slot of each table entry, and the end
  SlotPoints points_;
};

}  // namespace lanthorn
