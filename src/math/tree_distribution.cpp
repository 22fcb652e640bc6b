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
  nodes_.push_back({mass, nodes_[lower].mass / mass, static_cast<std::uint32_t>(axis), lower, upper});
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

TreeDistribution::Sample TreeDistribution::sample(const Numbers& u) const {
  if (nodes_.empty()) return {u, 1};
  Numbers rest = u;
  Cell cell;
  float pdf = 1;
  const Node* node = &nodes_.back();
  while (node->axis < dimensions) {
    const float p = node->lower_share;
    float& x = rest[node->axis];
    const bool upper = x >= p;
    x = std::min(upper ? (x - p) / (1 - p) : x / p, one_minus_epsilon);
    pdf *= 2 * (upper ? 1 - p : p);
    cell = cell.half(node->axis, upper);
    node = &nodes_[upper ? node->upper : node->lower];
  }
  return {cell.at(rest), pdf};
}

float TreeDistribution::pdf(const SomeNumbers& at) const { return nodes_.empty() ? 1 : pdf_in(&nodes_.back(), at); }

// `at`: relative to the node's cell.
float TreeDistribution::pdf_in(const Node* node, SomeNumbers at) const {
  float pdf = 1;
  while (node->axis < dimensions) {
    const float p = node->lower_share;
    std::optional<float>& x = at[node->axis];
    if (!x) return pdf * (p * pdf_in(&nodes_[node->lower], at) + (1 - p) * pdf_in(&nodes_[node->upper], at));
    const bool upper = *x >= 0.5f;
    x = 2 * *x - (upper ? 1.0f : 0.0f);  // exact
    pdf *= 2 * (upper ? 1 - p : p);
    node = &nodes_[upper ? node->upper : node->lower];
  }
  return pdf;
}

}  // namespace lanthorn
