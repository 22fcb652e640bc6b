// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "index/hash_grid.h"

#include <atomic>
#include <utility>

#include "base/parallel.h"

namespace lanthorn {

namespace {

constexpr std::size_t chunk = 1u << 14;
/// Width of the largest ball along x, in cells. Smaller cells along x need no further look-ups, and fewer points are
/// tested.
constexpr float cells_per_ball_x = 2;
constexpr float max_cells_per_axis = 0x1p20f;
/// Cells grow until their blocks hold this many points on average, which bounds the memory of the blocks.
constexpr std::size_t min_points_per_block = 16;
/// Points are first sorted by groups of blocks, at most 2^max_group_bits groups.
constexpr int max_group_bits = 10;

// Bounding box of the points, computed in parallel; empty if there are none.
Bounds bounds_of(std::span<const Point> points) {
  std::vector<Bounds> parts((points.size() + chunk - 1) / chunk);
  parallel_chunks(points.size(), chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    Bounds b;
    for (std::size_t i = begin; i < end; ++i) b.extend(points[i]);
    parts[c] = b;
  });
  Bounds all;
  for (const Bounds& b : parts) all.extend(b);
  return all;
}

}  // namespace

/// Numbers the occupied blocks in the order of their table entries. Returns false if there are too many blocks for the
/// number of points.
bool HashGrid::number_blocks(std::span<const Point> points) {
  parallel_chunks(points.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::atomic_ref<std::uint32_t> entry(block_number_[block_entry(cell_of(points[i]))]);
      if (entry.load(std::memory_order_relaxed) == 0) entry.store(1, std::memory_order_relaxed);
    }
  });
  std::uint32_t blocks = 0;
  for (std::uint32_t& number : block_number_)
    if (number != 0) number = ++blocks;
  blocks_.assign(blocks + 1, Block{});
  return blocks <= 64 || blocks <= points.size() / min_points_per_block;
}

void HashGrid::choose_cells(const Bounds& bounds, std::span<const Point> points) {
  block_number_.assign(1, 0);
  blocks_.assign(1, Block{});
  if (points.empty()) return;
  origin_ = bounds.min;
  const Vec3 extent = bounds.extent();
  const std::size_t max_entries = std::bit_ceil(points.size() / 4 + 64);
  float size =
      std::max({2 * safe_reach(radius_), max_component(extent) * cells_per_ball_x / max_cells_per_axis, 1e-18f});
  for (bool fits = false; !fits; size *= 2) {
    per_cell_ = Vec3(cells_per_ball_x, 1, 1) / size;
    std::array<std::size_t, 3> blocks;
    constexpr std::array<std::uint32_t, 3> block_size{Block::size_x, Block::size_y, Block::size_z};
    for (int axis = 0; axis < 3; ++axis) {
      last_cell_[axis] = std::floor(std::min(extent[axis] * per_cell_[axis], max_cells_per_axis));
      const auto a = static_cast<unsigned>(axis);
      blocks[a] = static_cast<std::size_t>(last_cell_[axis]) / block_size[a] + 1;
    }
    blocks_x_ = blocks[0], blocks_y_ = blocks[1];
    const std::size_t entries = blocks[0] * blocks[1] * blocks[2];
    hashed_ = entries > max_entries;
    block_number_.assign(hashed_ ? max_entries : entries, 0);
    fits = number_blocks(points);
  }
}

HashGrid::Groups HashGrid::group(std::span<const Point> points) const {
  Groups groups;
  groups.shift = std::max(0, static_cast<int>(std::bit_width(blocks_.size())) - max_group_bits);
  const std::size_t count = ((blocks_.size() - 1) >> groups.shift) + 1;
  const std::size_t chunks = (points.size() + chunk - 1) / chunk;

  // Counts by chunk × group, then turned into the positions at which each chunk writes its points.
  std::vector<std::uint32_t> place(chunks * count);
  const auto keyed = std::make_unique_for_overwrite<KeyedPoint[]>(points.size());
  parallel_chunks(points.size(), chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Cell at = cell_of(points[i]);
      const std::uint32_t block = block_number_[block_entry(at)];
      const std::uint32_t own_group = block >> groups.shift;
      const std::uint32_t block_in_group = block - (own_group << groups.shift);
      keyed[i] = {(block_in_group * Block::size_z + at.z % Block::size_z) * 64 + bit_of(at), own_group};
      ++place[c * count + own_group];
    }
  });
  groups.start.resize(count + 1);
  std::uint32_t total = 0;
  for (std::size_t g = 0; g < count; ++g) {
    groups.start[g] = total;
    for (std::size_t c = 0; c < chunks; ++c) total += std::exchange(place[c * count + g], total);
  }
  groups.start[count] = total;
  groups.points = std::make_unique_for_overwrite<KeyedPoint[]>(points.size());
  parallel_chunks(points.size(), chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      groups.points[place[c * count + keyed[i].number]++] = {keyed[i].key, static_cast<std::uint32_t>(i)};
  });
  return groups;
}

/// Fills the blocks, starts and slots of one group by a counting sort. `next` has one counter for each of its cells;
/// the counters are 0 before and after.
void HashGrid::sort_group(const Groups& groups, std::size_t g, std::vector<std::uint32_t>& next,
                          std::span<const Point> points, std::vector<std::uint32_t>& order) {
  const std::span own(groups.points.get() + groups.start[g], groups.points.get() + groups.start[g + 1]);
  const std::size_t first_block = g << groups.shift;
  const std::size_t last_block = std::min((g + 1) << groups.shift, blocks_.size());
  for (const KeyedPoint& p : own) {
    ++next[p.key];
    blocks_[first_block + p.key / Block::cells].occupied[p.key / 64 % Block::size_z] |= 1ull << p.key % 64;
  }
  // A group has fewer occupied cells than slots; the remaining entries of `starts_` stay unused.
  std::uint32_t slot = groups.start[g], start = slot;
  for (std::size_t b = first_block; b < last_block; ++b)
    for (std::size_t z = 0; z < Block::size_z; ++z) {
      const std::size_t first_key = ((b - first_block) * Block::size_z + z) * 64;
      blocks_[b].first_start[z] = start;
      for (std::uint64_t left = blocks_[b].occupied[z]; left != 0; left &= left - 1) {
        starts_[start++] = slot;
        slot += std::exchange(next[first_key + static_cast<std::size_t>(std::countr_zero(left))], slot);
      }
    }
  if (start < slot) starts_[start] = slot;  // otherwise this is the next group's first start, the same number
  for (const KeyedPoint& p : own) {
    const std::uint32_t to = next[p.key]++;
    order[to] = p.number;
    points_.set(to, points[p.number]);
  }
  for (const KeyedPoint& p : own) next[p.key] = 0;
}

void HashGrid::sort(std::span<const Point> points, std::vector<std::uint32_t>& order) {
  const Groups groups = group(points);
  starts_ = std::make_unique_for_overwrite<std::uint32_t[]>(points.size() + 1);
  starts_[points.size()] = static_cast<std::uint32_t>(points.size());
  points_ = SlotPoints(points.size());
  order.resize(points.size());
  parallel_chunks(groups.start.size() - 1, 8, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> next(std::size_t{Block::cells} << groups.shift);
    for (std::size_t g = begin; g < end; ++g) sort_group(groups, g, next, points, order);
  });
}

IndexBuild<HashGrid> HashGrid::build(std::span<const Point> points, float radius) {
  IndexBuild<HashGrid> built;
  HashGrid& grid = built.index;
  grid.radius_ = radius;
  grid.choose_cells(bounds_of(points), points);
  grid.sort(points, built.order);
  return built;
}

}  // namespace lanthorn
