// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/tree_distribution.h"

#include <algorithm>

#include "math/vec.h"

namespace lanthorn {

TreeDistribution::Cell TreeDistribution::Cell::half(std::size_t axis, bool upper) const {
  Cell result = *this;
  result.size[axis] *= 0.5f;
  if (upper) result.low[axis] += result.size[axis];
  return result;
}

TreeDistribution::Numbers TreeDistribution::Cell::at(const Numbers& t) const {
  Numbers result{};
  for (std::size_t i = 0; i < dimensions; ++i) result[i] = std::min(low[i] + t[i] * size[i], one_minus_epsilon);
  return result;
}

std::uint32_t TreeDistribution::add_leaf(float mass) {
  nodes_.push_back({mass});
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::uint32_t TreeDistribution::add_inner(std::size_t axis, std::uint32_t lower, std::uint32_t upper) {
  const float mass = nodes_[lower].mass + nodes_[upper].mass;
  const float p = nodes_[lower].mass / mass;
  nodes_.push_back({mass, static_cast<std::uint32_t>(axis), {p, 1 - p}, {lower, upper}});
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

// Which half a number lies in is unpredictable, so both walks below index by it instead of branching: a mispredicted
// branch would cost more than the node.

TreeDistribution::Sample TreeDistribution::sample(const Numbers& u) const {
  if (nodes_.empty()) return {u, 1};
  Numbers rest = u;
  Cell cell;
  float pdf = 1;
  const Node* node = &nodes_.back();
  while (node->axis < dimensions) {
    const std::size_t axis = node->axis;
    const std::array before{0.0f, node->share[0]};
    const std::size_t half = rest[axis] >= node->share[0] ? 1 : 0;
    rest[axis] = std::min((rest[axis] - before[half]) / node->share[half], one_minus_epsilon);
    pdf *= 2 * node->share[half];
    cell.size[axis] *= 0.5f;
    cell.low[axis] += static_cast<float>(half) * cell.size[axis];
    node = &nodes_[node->halves[half]];
  }
  return {cell.at(rest), pdf};
}

float TreeDistribution::pdf(const SomeNumbers& at) const {
  if (nodes_.empty()) return 1;
  Numbers numbers{};
  unsigned known = 0;
  for (unsigned i = 0; i < dimensions; ++i) {
    numbers[i] = at[i].value_or(0);
    known |= at[i] ? 1u << i : 0u;
  }
  return pdf_in(&nodes_.back(), numbers, known);
}

// `at`: relative to the node's cell. `known`: a bit for each axis.
float TreeDistribution::pdf_in(const Node* node, Numbers at, unsigned known) const {
  float pdf = 1;
  while (node->axis < dimensions) {
    const auto [p, q] = node->share;
    const auto [lower, upper] = node->halves;
    if ((known >> node->axis & 1u) == 0)
      return pdf * (p * pdf_in(&nodes_[lower], at, known) + q * pdf_in(&nodes_[upper], at, known));
    float& x = at[node->axis];
    const std::size_t half = x >= 0.5f ? 1 : 0;
    x = 2 * x - static_cast<float>(half);  // exact
    pdf *= 2 * node->share[half];
    node = &nodes_[node->halves[half]];
  }
  return pdf;
}

}  // namespace lanthorn
