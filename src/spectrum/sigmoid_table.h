// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace lanthorn {

/// Nodes per axis. Odd, so that a largest component of 1/2 (every light, every unbounded colour) is a node itself.
inline constexpr std::size_t sigmoid_nodes = 33;

using SigmoidNode = std::array<float, 3>;

/// Coefficients, for wavelengths in nm, of sRGB colours, indexed by the largest component (0 red, 1 green, 2 blue), its
/// value's node, then the next component but one and the next component, both divided by the largest and in equal
/// steps (Jakob & Hanika 2019, section 4). Written by `make_sigmoid_table` at build time.
extern const std::array<SigmoidNode, 3 * sigmoid_nodes * sigmoid_nodes * sigmoid_nodes> sigmoid_table;

constexpr std::size_t sigmoid_index(std::size_t largest, std::size_t value, std::size_t next_but_one,
                                    std::size_t next) {
  return ((largest * sigmoid_nodes + value) * sigmoid_nodes + next_but_one) * sigmoid_nodes + next;
}

/// Value of the largest component at node i: dense near 0 and 1, where the coefficients vary fastest.
constexpr double sigmoid_node_value(std::size_t i) {
  const auto smooth = [](double x) { return x * x * (3 - 2 * x); };
  return smooth(smooth(static_cast<double>(i) / (sigmoid_nodes - 1)));
}

}  // namespace lanthorn
