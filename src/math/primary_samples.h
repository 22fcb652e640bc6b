// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Primary sample space (Kelemen, Szirmay-Kalos, Antal & Csonka 2002, "A Simple and Robust Mutation Strategy for the
// Metropolis Light Transport Algorithm"): a path is represented and mutated by its random numbers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace lanthorn {

/// How a Markov chain proposes its next path.
enum class Mutation : std::uint8_t { small, large };

/// The random numbers of one path of a Markov chain, in `Sampler`'s groups of four dimensions, as many groups as are
/// read. Groups are mutated lazily, when they are read: a group that the path has not read for some mutations catches
/// up. Every number is a function of the chain's key, the number of the mutation and the group.
class PrimarySamples {
 public:
  static constexpr std::size_t group_size = 4;
  using Group = std::array<float, group_size>;

  /// `sigma`: standard deviation of a small mutation of a number in [0,1); numbers wrap around.
  explicit PrimarySamples(float sigma) : sigma_(sigma) {}

  /// Resets the chain: all numbers are drawn uniformly from `key`.
  void start(std::uint64_t key);
  /// Sets the key of all later mutations, so that chains that start from the same path diverge.
  void set_key(std::uint64_t key) { key_ = key; }

  /// Proposes a mutation, to be ended by `accept` or `reject`. Small: each number moves by a normal deviate. Large: all
  /// numbers are drawn anew. Both proposals are symmetric and preserve the uniform distribution.
  void propose(Mutation mutation);
  void accept();
  /// Restores all numbers to their values before `propose`.
  void reject();

  const Group& group(std::uint32_t index) { return up_to_date(index).values; }
  /// Seed of a generator for random decisions beyond the group's four numbers (flights through media). A small mutation
  /// redraws the seed with probability 1/8, because a generator's numbers cannot move in small steps.
  std::uint64_t seed_of(std::uint32_t index) { return up_to_date(index).seed; }

 private:
  struct Numbers {
    Group values{};
    std::uint64_t seed = 0;
    std::uint64_t modified = 0;  ///< time of the accepted mutation that last changed them; 0: never drawn
  };
  struct Entry : Numbers {
    Numbers before;  ///< values before the proposed mutation
  };

  Entry& up_to_date(std::uint32_t index);
  void draw(Numbers& numbers, std::uint32_t index, std::uint64_t salt) const;
  void perturb(Numbers& numbers, std::uint32_t index, std::uint64_t mutations) const;

  float sigma_;
  std::uint64_t key_ = 0;
  std::uint64_t time_ = 1;     ///< number of accepted mutations, including the start and the proposed one
  std::uint64_t number_ = 0;   ///< number of the mutation, counting rejected ones
  std::uint64_t redrawn_ = 1;  ///< time of the last large mutation
  std::uint64_t redrawn_before_ = 1;
  std::vector<Entry> entries_;
};

}  // namespace lanthorn
