// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How sums reach rank 0.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "lanthorn/error.h"
#include "render/state.h"

namespace lanthorn {

/// The sums of a round. A process that has rendered no pass of the round has none.
using RoundSums = std::optional<RenderState>;

/// Sums go up a tree: each process adds those of its children to its own and passes them on to its parent, so that rank
/// 0 receives two states of a round and not as many as there are processes. Film sums are exact, so the result
/// does not depend on the tree.
class Gathering {
 public:
  Gathering(int rank, int size) : awaited_(1 + children(rank, size)) {}

  static int parent(int rank) { return (rank - 1) / 2; }
  static int children(int rank, int size) { return (2 * rank + 1 < size ? 1 : 0) + (2 * rank + 2 < size ? 1 : 0); }

  /// Adds the sums of this process or, with all below it, of a child. Throws Error if the round is already taken: then
  /// the processes do not agree on the tree.
  void add(std::uint64_t round, RoundSums sums) {
    if (taken_ && round <= *taken_)
      throw Error(fmt::format("sums of round {} arrive after this process has passed that round on", round));
    Part& part = parts_[round];
    ++part.arrived;
    if (!part.sums)
      part.sums = std::move(sums);
    else if (sums)
      add_state(*part.sums, *sums);
  }

  /// Removes and returns the sums of the oldest round if nothing of it is missing.
  std::optional<std::pair<std::uint64_t, RoundSums>> take_complete() {
    if (parts_.empty() || parts_.begin()->second.arrived < awaited_) return std::nullopt;
    auto node = parts_.extract(parts_.begin());
    taken_ = node.key();
    return std::pair(node.key(), std::move(node.mapped().sums));
  }

  bool is_empty() const { return parts_.empty(); }

 private:
  struct Part {
    int arrived = 0;
    RoundSums sums;
  };
  int awaited_;
  std::optional<std::uint64_t> taken_;  // the last round
  std::map<std::uint64_t, Part> parts_;
};

}  // namespace lanthorn
