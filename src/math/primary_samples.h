// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Primary sample space (Kelemen, Szirmay-Kalos, Antal & Csonka 2002, "A Simple and Robust Mutation Strategy for the
// Metropolis Light Transport Algorithm"): a path is the random numbers that it is made of, and is mutated by them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace lanthorn {

/// How a Markov chain proposes its next path.
enum class Mutation : std::uint8_t { small, large };

/// The random numbers of one path of a Markov chain, in `Sampler`'s groups of four dimensions, as many as are asked
/// for. Groups are mutated when they are read (lazily): one that the path has not read for some mutations catches up.
/// Every number is a function of the chain's key, the mutation's number and the group.
class PrimarySamples {
 public:
  static constexpr std::size_t group_size = 4;
  using Group = std::array<float, group_size>;

  /// `sigma`: standard deviation of a small mutation of a number in [0,1), which wraps around.
  explicit PrimarySamples(float sigma) : sigma_(sigma) {}

  /// Forgets all: the numbers are uniform ones of this key.
  void start(std::uint64_t key);
  /// Mutations from now on are of this key, so that chains that start from the same path part.
  void set_key(std::uint64_t key) { key_ = key; }

  /// Begins a mutation, to be ended by `accept` or `reject`. Small: each number moves by a normal deviate; large: all
  /// numbers are drawn anew. Both are symmetric, and uniform numbers stay uniform.
  void propose(Mutation mutation);
  void accept();
  /// Gives all numbers back the values that they had before `propose`.
  void reject();

  const Group& group(std::uint32_t index) { return up_to_date(index).values; }
  /// Seed of a generator for what the group's four numbers do not decide (flights through media). A small mutation
  /// draws it anew with a probability of 1/8: there are no small steps of a generator's numbers.
  std::uint64_t seed_of(std::uint32_t index) { return up_to_date(index).seed; }

 private:
  struct Numbers {
    Group values{};
    std::uint64_t seed = 0;
    std::uint64_t modified = 0;  ///< by which of the accepted mutations; 0: never drawn
  };
  struct Entry : Numbers {
    Numbers before;  ///< the mutation that is proposed
  };

  Entry& up_to_date(std::uint32_t index);
  void draw(Numbers& numbers, std::uint32_t index, std::uint64_t salt) const;
  void perturb(Numbers& numbers, std::uint32_t index, std::uint64_t mutations) const;

  float sigma_;
  std::uint64_t key_ = 0;
  std::uint64_t time_ = 1;     ///< accepted mutations, the start included, and the one that is proposed
  std::uint64_t number_ = 0;   ///< of the mutation, rejected ones counted
  std::uint64_t redrawn_ = 1;  ///< time of the last large mutation
  std::uint64_t redrawn_before_ = 1;
  std::vector<Entry> entries_;
};

}  // namespace lanthorn
