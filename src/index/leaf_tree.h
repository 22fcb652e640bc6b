// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The topology that the bounding volume hierarchies share: eight items per leaf, eight children per node. Leaves are
// numbered consecutively, and node n of a level has the children 8n to 8n + 7 of the level below. The topology depends
// only on the number of leaves, so nodes store only bounds.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "index/select_rank.h"
#include "index/wave.h"
#include "math/lanes.h"

namespace lanthorn {

/// An item with the point that it is sorted by, and its number in the input.
struct alignas(16) LeafPoint {
  std::array<float, 3> key;
  std::uint32_t number;
};

namespace detail {

/// The dimension in which the keys differ most. Items start with `key`, an array of floats, and have 16 or 32 bytes, so
/// that one or two fill the lanes; their remaining bytes are ignored.
template <class Item>
std::size_t widest_dimension(std::span<const Item> items) {
  constexpr std::size_t dimensions = std::tuple_size_v<decltype(Item::key)>, words = sizeof(Item) / sizeof(float);
  constexpr std::size_t together = Lanes::width / words;
  static_assert(sizeof(Item) * together == sizeof(float) * Lanes::width);
  const auto load = [&](std::size_t i) {
    std::array<float, Lanes::width> values;
    std::memcpy(values.data(), static_cast<const void*>(&items[i]), sizeof(values));
    return Lanes(values);
  };
  // Starts with the last items; if the number of items is odd, one of them is read again below, which does no harm.
  // There are more items than lanes.
  Lanes low = load(items.size() - together), high = low;
  for (std::size_t i = 0; i + together <= items.size(); i += together) {
    const Lanes values = load(i);
    low = min(low, values);
    high = max(high, values);
  }
  const auto lows = low.stored(), highs = high.stored();
  std::size_t widest = 0;
  float width = -1;
  for (std::size_t d = 0; d < dimensions; ++d) {
    float least = lows[d], greatest = highs[d];
    for (std::size_t other = d + words; other < Lanes::width; other += words) {
      least = std::min(least, lows[other]);
      greatest = std::max(greatest, highs[other]);
    }
    if (greatest - least > width) width = greatest - least, widest = d;
  }
  return widest;
}

}  // namespace detail

/// Sorts items so that each consecutive eight form a leaf: splits them into halves in the dimension in which their keys
/// differ most, recursively. First halves are complete trees. The result depends only on the items.
template <class Item>
void sort_into_leaves(std::span<Item> items) {
  constexpr std::size_t parallel_size = 1u << 13;  // smaller ranges are sorted by one thread
  if (items.size() <= Lanes::width) return;
  const std::size_t leaves = (items.size() + Lanes::width - 1) / Lanes::width;
  const std::size_t middle = std::bit_ceil(leaves) / 2 * Lanes::width;
  const std::size_t axis = detail::widest_dimension<Item>(items);
  select_rank(items, middle, [axis](const Item& item) { return item.key[axis]; });
  const auto first = [&] { sort_into_leaves(items.first(middle)); };
  const auto second = [&] { sort_into_leaves(items.subspan(middle)); };
  if (items.size() > parallel_size) {
    parallel_invoke(first, second);
  } else {
    first();
    second();
  }
}

/// Leaves, and bounds of leaves and of the nodes above them. `Node` holds the bounds of its eight children: it has a
/// type `Bound` with `extend(const Bound&)`, empty by default, and is constructed from a span of them.
template <class Node, class Leaf>
class LeafTree {
 public:
  using Bound = typename Node::Bound;

  LeafTree() = default;
  /// `count` items, fewer than 2^32; their leaves, and the bounds of each leaf.
  LeafTree(std::size_t count, std::vector<Leaf> leaves, std::vector<Bound> bounds)
      : size_(count), leaves_(std::move(leaves)) {
    std::size_t nodes = 0;
    for (std::size_t below = leaves_.size(); below > 0; below = below > width ? parents_of(below) : 0) {
      first_[levels_++] = nodes;
      nodes += parents_of(below);
    }
    nodes_.resize(nodes);
    for (std::size_t level = 0; level < levels_; ++level) bounds = make_level(level, bounds);
  }

  /// Searches all leaves whose nodes overlap the query, in an order that depends only on tree and query.
  /// `overlaps(node)` returns one bit per overlapping child, `test(leaf)` one bit per candidate lane; for each such
  /// lane that holds an item, calls `visit(place)` with the item's number in the order of the leaves.
  template <class Overlaps, class Test, class Visit>
  void search(Overlaps&& overlaps, Test&& test, Visit&& visit) const {
    if (leaves_.empty()) return;
    search_in_waves(
        nodes_, static_cast<std::uint32_t>(nodes_.size() - 1),
        [&](std::uint32_t number, std::size_t depth) {
          const std::size_t level = levels_ - 1 - depth, first = (number - first_[level]) * width;
          const std::uint32_t lanes = overlaps(nodes_[number]) & lanes_of(count_below(level) - first);
          const std::size_t before = level == 0 ? 0 : first_[level - 1];
          return WaveChildren{static_cast<std::uint32_t>(before + first), lanes, level == 0};
        },
        [&](const Wave& found) {
          found.for_each(leaves_, [&](std::uint32_t number) {
            const std::uint32_t first = number * width;
            for (std::uint32_t hit = test(leaves_[number]) & lanes_of(size_ - first); hit != 0; hit &= hit - 1)
              visit(first + static_cast<std::uint32_t>(std::countr_zero(hit)));
          });
        });
  }

  std::size_t size() const { return size_; }
  const Leaf& leaf_of(std::uint32_t slot) const { return leaves_[slot / width]; }
  std::size_t memory_bytes() const { return std::span(leaves_).size_bytes() + std::span(nodes_).size_bytes(); }

 private:
  static constexpr std::uint32_t width = Lanes::width;
  static constexpr std::size_t max_levels = 10;

  static std::size_t parents_of(std::size_t children) { return (children + width - 1) / width; }
  /// A mask of the first `count` lanes, at most of all lanes.
  static std::uint32_t lanes_of(std::size_t count) { return (1u << std::min<std::size_t>(count, width)) - 1; }
  /// Number of children of all nodes of a level; the children of level 0 are leaves.
  std::size_t count_below(std::size_t level) const {
    return (leaves_.size() + (std::size_t{1} << 3 * level) - 1) >> 3 * level;
  }
  /// Writes the nodes of a level, given the bounds of their children, and returns the nodes' bounds.
  std::vector<Bound> make_level(std::size_t level, const std::vector<Bound>& children) {
    std::vector<Bound> bounds(parents_of(children.size()));
    parallel_chunks(bounds.size(), 1u << 9, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        const std::span<const Bound> of_node = std::span(children).subspan(n * width);
        const auto first = of_node.first(std::min<std::size_t>(width, of_node.size()));
        nodes_[first_[level] + n] = Node(first);
        for (const Bound& child : first) bounds[n].extend(child);
      }
    });
    return bounds;
  }

  std::size_t size_ = 0;
  std::size_t levels_ = 0;
  std::array<std::size_t, max_levels> first_{};  ///< first node of each level
  std::vector<Leaf> leaves_;
  std::vector<Node> nodes_;
};

}  // namespace lanthorn
