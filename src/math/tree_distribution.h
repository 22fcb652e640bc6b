// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lanthorn {

/// Density on [0,1)^4 that is constant in each cell of a binary subdivision, whose cells are halved along one axis at a
/// time. Uniform if there are no nodes. Immutable once the root, the last node, is added.
class TreeDistribution {
 public:
  static constexpr std::size_t dimensions = 4;
  using Numbers = std::array<float, dimensions>;
  using SomeNumbers = std::array<std::optional<float>, dimensions>;

  /// A cell of the subdivision: [low, low + size) along each axis.
  struct Cell {
    Numbers low{0, 0, 0, 0}, size{1, 1, 1, 1};

    Cell half(std::size_t axis, bool upper) const;
    float volume() const { return size[0] * size[1] * size[2] * size[3]; }
    /// The point of the cell at relative position `t` in [0,1]^4.
    Numbers at(const Numbers& t) const;
  };
  struct Sample {
    Numbers at{};
    float pdf = 1;
  };

  // Children are added before their parents. Both functions return the node's number.

  /// Adds a cell that is not subdivided. `mass` > 0: its probability, up to a factor common to all cells.
  std::uint32_t add_leaf(float mass);
  std::uint32_t add_inner(std::size_t axis, std::uint32_t lower, std::uint32_t upper);

  /// Monotone in each number, so stratification is preserved.
  Sample sample(const Numbers& u) const;
  /// Density of these numbers, integrated over those that are empty.
  float pdf(const SomeNumbers& at) const;
  std::size_t size() const { return nodes_.size(); }

 private:
  struct Node {
    float mass = 0;
    std::uint32_t axis = dimensions;            ///< `dimensions` for a leaf
    std::array<float, 2> share{1, 0};           ///< probabilities of the lower and the upper half of an inner node
    std::array<std::uint32_t, 2> halves{0, 0};  ///< their nodes
  };
  float pdf_in(const Node* node, Numbers at, unsigned known) const;

  std::vector<Node> nodes_;
};

}  // namespace lanthorn
