// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "index/point_index.h"
#include "index/slot_points.h"
#include "math/vec.h"

namespace lanthorn {

/// Points sorted by the cells of a regular grid, for queries up to a fixed maximum radius: progressive photon mapping,
/// vertex merging.
///
/// A cell is as wide as the largest ball (half as wide along x), so a query visits 2 × 2 rows of cells. Cells are
/// grouped in blocks of 16 × 4 × 8. A table holds each block's number: one entry for each block of the points' bounds
/// or, if these are too many, one for each hash value. An occupied block has one bit per cell, set if the cell holds
/// points (Jacobson's rank structure): an empty cell costs an eighth of a byte, and most cells are empty if the points
/// lie on surfaces.
///
/// Blocks with equal hash values share their cells; the distance test separates their points. No point is visited
/// twice, because the cells of one query have different positions inside their blocks.
class HashGrid {
 public:
  /// Sorts the points for queries of radius <= `radius` (m, >= 0, finite). Points must be finite, fewer than 2^32.
  static IndexBuild<HashGrid> build(std::span<const Point> points, float radius);

  /// See `PointIndex`. `radius` must not exceed the one given to `build`.
  template <class Visit>
  void for_each_near(const Point& p, float radius, Visit&& visit) const {
    assert(radius <= radius_);
    const float reach = safe_reach(radius);
    const Cell low{cell(0, p.x - reach), cell(1, p.y - reach), cell(2, p.z - reach)};
    const Cell high{cell(0, p.x + reach), cell(1, p.y + reach), cell(2, p.z + reach)};
    std::array<SlotRange, max_ranges> ranges;
    std::uint32_t count = 0;
    for (std::uint32_t z = low.z; z <= high.z; ++z)
      for (std::uint32_t y = low.y; y <= high.y; ++y)
        for (std::uint32_t x = low.x; x <= high.x; x = (x | (Block::size_x - 1)) + 1) {
          ranges[count] = slots_of({x, y, z}, std::min(high.x, x | (Block::size_x - 1)));
          count += static_cast<std::uint32_t>(ranges[count].begin < ranges[count].end);
        }
    points_.for_each_near(std::span(ranges.data(), count), p, radius * radius, visit);
  }

  std::size_t size() const { return points_.size(); }
  Point position(std::uint32_t slot) const { return points_[slot]; }
  /// Largest radius of queries (m).
  float radius() const { return radius_; }
  /// Positions and cell tables, bytes.
  std::size_t memory_bytes() const { return points_.memory_bytes() + table_bytes(); }
  /// Memory of the cell tables only, bytes.
  std::size_t table_bytes() const {
    return block_number_.size() * sizeof(std::uint32_t) + blocks_.size() * sizeof(Block) +
           (size() + 1) * sizeof(std::uint32_t);
  }

 private:
  struct Cell {
    std::uint32_t x, y, z;
  };
  struct Block {
    static constexpr std::uint32_t size_x = 16, size_y = 4, size_z = 8;
    static constexpr std::uint32_t cells = size_x * size_y * size_z;

    std::array<std::uint64_t, size_z> occupied{};     ///< per z, bit 16 y + x
    std::array<std::uint32_t, size_z> first_start{};  ///< per z, where in `starts_` its occupied cells begin
  };
  /// A ball touches at most 3 cells along y and z, and at most 2 blocks along x.
  static constexpr std::size_t max_ranges = 3 * 3 * 2;

  /// Cell coordinate, clamped to the grid. Monotonic in x, because a difference followed by a product cannot be fused.
  /// A point between two bounds therefore always lies in a cell between the cells of the bounds.
  std::uint32_t cell(int axis, float x) const {
    const float c = (x - origin_[axis]) * per_cell_[axis];
    return c > 0 ? static_cast<std::uint32_t>(std::min(c, last_cell_[axis])) : 0;
  }
  Cell cell_of(const Point& p) const { return {cell(0, p.x), cell(1, p.y), cell(2, p.z)}; }
  /// Entry of `block_number_` for the block of a cell.
  std::size_t block_entry(const Cell& c) const {
    const std::uint32_t x = c.x / Block::size_x, y = c.y / Block::size_y, z = c.z / Block::size_z;
    if (!hashed_) return (std::size_t{z} * blocks_y_ + y) * blocks_x_ + x;
    std::uint64_t h = (std::uint64_t{z} << 42 ^ std::uint64_t{y} << 21 ^ x) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ h >> 32) * 0x94d049bb133111ebull;
    return h >> 32 & (block_number_.size() - 1);
  }
  /// Bit of a cell in the word of its z.
  static std::uint32_t bit_of(const Cell& c) { return c.y % Block::size_y * Block::size_x + c.x % Block::size_x; }
  /// Slots of the cells from `c` to x = last_x, all in one block.
  SlotRange slots_of(const Cell& c, std::uint32_t last_x) const {
    const Block& block = blocks_[block_number_[block_entry(c)]];
    const std::uint32_t layer = c.z % Block::size_z, bit = bit_of(c);
    const std::uint64_t from = block.occupied[layer] >> bit;
    const std::uint64_t upto = from & ((2ull << (last_x - c.x)) - 1);
    const std::uint32_t first = block.first_start[layer] +
                                static_cast<std::uint32_t>(std::popcount(block.occupied[layer]) - std::popcount(from));
    return {starts_[first], starts_[first + static_cast<std::uint32_t>(std::popcount(upto))]};
  }

  /// A point's number in the input, and its cell within its group (or, during sorting, its group).
  struct KeyedPoint {
    std::uint32_t key, number;
  };
  /// The points sorted by groups of 2^shift consecutive blocks; group g begins at start[g].
  struct Groups {
    int shift;
    std::vector<std::uint32_t> start;
    std::unique_ptr<KeyedPoint[]> points;
  };

  void choose_cells(const Bounds& bounds, std::span<const Point> points);
  bool number_blocks(std::span<const Point> points);
  Groups group(std::span<const Point> points) const;
  void sort_group(const Groups& groups, std::size_t g, std::vector<std::uint32_t>& next, std::span<const Point> points,
                  std::vector<std::uint32_t>& order);
  void sort(std::span<const Point> points, std::vector<std::uint32_t>& order);

  float radius_ = 0;
  Vec3 origin_{0};
  Vec3 per_cell_{0};   ///< cells per metre
  Vec3 last_cell_{0};  ///< largest cell coordinate
  bool hashed_ = false;
  std::size_t blocks_x_ = 1, blocks_y_ = 1;
  std::vector<std::uint32_t> block_number_;  ///< 0: empty
  std::vector<Block> blocks_;                ///< the first one is empty
  std::unique_ptr<std::uint32_t[]> starts_;  ///< first slot of each occupied cell
  SlotPoints points_;
};

}  // namespace lanthorn
