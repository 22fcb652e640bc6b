// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Breadth-first search of the bounding volume hierarchies, whose nodes have up to eight children: processes as many
// nodes at a time as a wave holds. Visiting nodes one by one would make the processor predict how many children follow
// and wait for their memory, which took most of the search time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "base/prefetch.h"
#include "math/lanes.h"

namespace lanthorn {

/// Children of a node to be searched: number `first` + i for each set bit i.
struct WaveChildren {
  std::uint32_t first, lanes;
  bool are_leaves;
};

/// Numbers of nodes or leaves to be searched.
class Wave {
 public:
  static constexpr std::size_t most = 128;

  bool empty() const { return count_ == 0; }
  bool has_room() const { return count_ <= most - Lanes::width; }
  void clear() { count_ = 0; }
  /// Branchless: half of the branches would be mispredicted. The wave must have room.
  void append(const WaveChildren& children) {
    for (std::uint32_t lane = 0; lane < Lanes::width; ++lane) {
      numbers_[count_] = children.first + lane;
      count_ += children.lanes >> lane & 1u;
    }
  }

  /// Calls `visit(number)` for each entry, with items[number] prefetched ahead.
  template <class Items, class Visit>
  void for_each(const Items& items, Visit&& visit) const {
    constexpr std::size_t ahead = 4;
    for (std::size_t i = 0; i < std::min(ahead, count_); ++i) prefetch(items[numbers_[i]]);
    for (std::size_t i = 0; i < count_; ++i) {
      prefetch(items[numbers_[std::min(i + ahead, count_ - 1)]]);
      visit(numbers_[i]);
    }
  }

 private:
  std::array<std::uint32_t, most> numbers_;
  std::size_t count_ = 0;
};

/// Searches below the nodes of a wave, which are `depth` levels below the root. Calls `children_of(number, depth)` for
/// each node, and `search_leaves(leaves)` whenever many leaves are known; the remaining ones are left to the caller.
template <class Nodes, class ChildrenOf, class SearchLeaves>
void search_below(const Nodes& nodes, const Wave& wave, std::size_t depth, Wave& leaves, ChildrenOf&& children_of,
                  SearchLeaves&& search_leaves) {
  Wave below;
  const auto search_children = [&] { search_below(nodes, below, depth + 1, leaves, children_of, search_leaves); };
  wave.for_each(nodes, [&](std::uint32_t number) {
    const WaveChildren children = children_of(number, depth);
    (children.are_leaves ? leaves : below).append(children);
    if (!leaves.has_room()) {
      search_leaves(leaves);
      leaves.clear();
    }
    if (!below.has_room()) {
      search_children();
      below.clear();
    }
  });
  if (!below.empty()) search_children();
}

/// Searches a tree from its root, in an order that depends only on the tree and `children_of`.
template <class Nodes, class ChildrenOf, class SearchLeaves>
void search_in_waves(const Nodes& nodes, std::uint32_t root, ChildrenOf&& children_of, SearchLeaves&& search_leaves) {
  Wave wave, leaves;
  wave.append({root, 1, false});
  search_below(nodes, wave, 0, leaves, children_of, search_leaves);
  search_leaves(leaves);
}

}  // namespace lanthorn
