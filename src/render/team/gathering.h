// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How sums reach rank 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/state.h"

namespace lanthorn {

/// The sums of a round. nullopt: the process has rendered no pass of the round.
using RoundSums = std::optional<RenderState>;

/// The same sums as the bytes of a state; empty if there are none. `name`: of the process, in messages.
struct PackedSums {
  std::vector<std::byte> bytes;
  std::string name;
};

/// Sums go up a tree: each process adds the sums of its children to its own and passes them on to its parent. So rank 0
/// receives two states per round, not one from each process. Film sums are exact, so the result does not depend on the
/// tree. The states of the children are added block by block, without a film of their own.
class Gathering {
 public:
  Gathering(int rank, int size) : awaited_(1 + children(rank, size)) {}

  static int parent(int rank) { return (rank - 1) / 2; }
  static int children(int rank, int size) { return (2 * rank + 1 < size ? 1 : 0) + (2 * rank + 2 < size ? 1 : 0); }
  /// How many other processes pass their sums on to this one.
  int awaited_children() const { return awaited_ - 1; }

  /// Adds the sums of this process. Throws Error if the round is already taken: then the processes do not agree on the
  /// tree.
  void add_own(std::uint64_t round, RoundSums sums);
  /// Adds the sums of a child with all below it. Throws Error likewise, and if the bytes are damaged.
  void add_child(std::uint64_t round, PackedSums sums);

  struct Complete {
    std::uint64_t round = 0;
    RoundSums sums;
    PackedSums packed;  ///< the sums, if they are those of one child alone; `sums` is then empty

    /// The sums, unpacked or packed.
    RoundSums take_sums();
    std::vector<std::byte> take_bytes();
  };
  /// Removes and returns the sums of the oldest round if nothing of it is missing.
  std::optional<Complete> take_complete();

  bool is_empty() const { return parts_.empty(); }

 private:
  struct Part {
    int arrived = 0;
    RoundSums sums;
    std::vector<PackedSums> waiting;  // until there are sums to add them to
  };
  Part& part_of(std::uint64_t round);

  int awaited_;
  std::optional<std::uint64_t> taken_;  // the last round
  std::map<std::uint64_t, Part> parts_;
};

/// Checks that each process waits for exactly those processes that pass their sums on to it; otherwise it would wait
/// for ever, or sums would be lost. Rank 0 knows the tree as each process sees it.
class TreeCheck {
 public:
  TreeCheck(int size, int awaited_at_first);

  /// Takes the statement of process `rank`: the rank that it passes its sums on to, and the number of children it waits
  /// for. Throws Error once all have joined if they do not agree.
  void join(int rank, std::uint64_t parent, std::uint64_t awaited);

 private:
  struct View {
    std::uint64_t awaited = 0, senders = 0;
  };
  std::vector<View> views_;  // by rank
  int missing_;
};

}  // namespace lanthorn
