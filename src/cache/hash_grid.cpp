// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "cache/hash_grid.h"

#include <atomic>

#include "base/parallel.h"
#include "cache/bounds_of.h"

namespace lanthorn {

namespace {

constexpr std::size_t chunk = 1u << 14;
constexpr float max_cells_per_axis = 0x1p20f;
/// Cells grow until their blocks hold this many points on average, which bounds the memory of blocks.
constexpr std::size_t min_points_per_block = 16;
/// Sorting first goes by groups of blocks, at most 2^max_group_bits.
constexpr int max_group_bits = 10;

struct KeyedPoint {
  std::uint32_t key, number;
};

}  // namespace

/// Numbers the occupied blocks in the order of their table entries; false if they are too many for the points.
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
  float size = std::max({2 * safe_reach(radius_), max_component(extent) / max_cells_per_axis, 1e-18f});
  for (bool fits = false; !fits; size *= 2) {
    per_cell_ = 1.0f / size;
    std::array<std::size_t, 3> blocks;
    constexpr std::array<std::uint32_t, 3> block_size{Block::size_x, Block::size_y, Block::size_z};
    for (int axis = 0; axis < 3; ++axis) {
      last_cell_[axis] = std::floor(std::min(extent[axis] * per_cell_, max_cells_per_axis));
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

void HashGrid::sort(std::span<const Point> points, std::vector<std::uint32_t>& order) {
  const int group_shift = std::max(0, static_cast<int>(std::bit_width(blocks_.size())) - max_group_bits);
  const std::size_t blocks_per_group = std::size_t{1} << group_shift;
  const std::size_t groups = (blocks_.size() + blocks_per_group - 1) >> group_shift;
  const std::size_t keys_per_group = blocks_per_group * Block::cells;
  const std::size_t chunks = (points.size() + chunk - 1) / chunk;

  // Sizes of chunk × group, then turned into the places where each chunk puts its points.
  std::vector<std::uint32_t> place(chunks * groups);
  const auto keys = std::make_unique_for_overwrite<KeyedPoint[]>(points.size());
  parallel_chunks(points.size(), chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Cell at = cell_of(points[i]);
      const std::uint32_t block = block_number_[block_entry(at)];
      const std::uint32_t group = block >> group_shift;
      const std::uint32_t block_in_group = block - (group << group_shift);
      keys[i] = {(block_in_group * Block::size_z + at.z % Block::size_z) * 64 + bit_of(at), group};
      ++place[c * groups + group];
    }
  });
  std::vector<std::uint32_t> group_start(groups + 1);
  std::uint32_t total = 0;
  for (std::size_t g = 0; g < groups; ++g) {
    group_start[g] = total;
    for (std::size_t c = 0; c < chunks; ++c) {
      const std::uint32_t size = place[c * groups + g];
      place[c * groups + g] = total;
      total += size;
    }
  }
  group_start[groups] = total;
  const auto grouped = std::make_unique_for_overwrite<KeyedPoint[]>(points.size());
  parallel_chunks(points.size(), chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      grouped[place[c * groups + keys[i].number]++] = {keys[i].key, static_cast<std::uint32_t>(i)};
  });

  starts_ = std::make_unique_for_overwrite<std::uint32_t[]>(points.size() + 1);
  starts_[points.size()] = total;
  points_ = SlotPoints(points.size());
  order.resize(points.size());
  parallel_chunks(groups, 8, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> next(keys_per_group);
    std::vector<std::uint64_t> occupied(keys_per_group / 64);
    for (std::size_t g = begin; g < end; ++g) {
      for (std::uint32_t i = group_start[g]; i < group_start[g + 1]; ++i) {
        ++next[grouped[i].key];
        occupied[grouped[i].key / 64] |= 1ull << grouped[i].key % 64;
      }
      std::uint32_t slot = group_start[g], start = slot;
      const std::size_t words = std::min(blocks_per_group, blocks_.size() - g * blocks_per_group) * Block::size_z;
      for (std::size_t word = 0; word < words; ++word) {
        Block& block = blocks_[g * blocks_per_group + word / Block::size_z];
        block.first_start[word % Block::size_z] = start;
        block.occupied[word % Block::size_z] = occupied[word];
        for (std::uint64_t left = occupied[word]; left != 0; left &= left - 1) {
          std::uint32_t& n = next[word * 64 + static_cast<std::size_t>(std::countr_zero(left))];
          starts_[start++] = slot;
          slot += std::exchange(n, slot);
        }
      }
      if (start < slot) starts_[start] = slot;
      for (std::uint32_t i = group_start[g]; i < group_start[g + 1]; ++i) {
        const std::uint32_t to = next[grouped[i].key]++;
        order[to] = grouped[i].number;
        points_.set(to, points[grouped[i].number]);
      }
      for (std::uint32_t i = group_start[g]; i < group_start[g + 1]; ++i) next[grouped[i].key] = 0;
      std::fill(occupied.begin(), occupied.end(), 0u);
    }
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
