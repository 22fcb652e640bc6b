// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace lanthorn {

/// Nodes per axis. Odd, so that a largest component of 1/2 (every light, every unbounded colour) is a node itself.
inline constexpr std::size_t sigmoid_nodes = 33;

using SigmoidNode = std::array<float, 3>;

/// Coefficients of sRGB colours, for wavelengths in nm. Indices: which component is the largest (0 red, 1 green, 2
/// blue), the node of its value, then the nodes of the ratios of the next component but one and of the next component
/// to the largest. After Jakob & Hanika 2019, section 4; unlike there, the nodes of the ratios are also dense near 0
/// and 1, for saturated colours and whites. Written by `make_sigmoid_table` at build time.
extern const std::array<SigmoidNode, 3 * sigmoid_nodes * sigmoid_nodes * sigmoid_nodes> sigmoid_table;

constexpr std::size_t sigmoid_index(std::size_t largest, std::size_t value, std::size_t next_but_one,
                                    std::size_t next) {
  return ((largest * sigmoid_nodes + value) * sigmoid_nodes + next_but_one) * sigmoid_nodes + next;
}

constexpr double smooth_step(double x) { return x * x * (3 - 2 * x); }

/// Ratio of a component to the largest at node i.
constexpr double sigmoid_node_ratio(std::size_t i) { return smooth_step(static_cast<double>(i) / (sigmoid_nodes - 1)); }
/// Value of the largest component at node i. Not 0 at the first node, because the coefficients of black are infinite.
constexpr double sigmoid_node_value(std::size_t i) { return i == 0 ? 1e-5 : smooth_step(sigmoid_node_ratio(i)); }

}  // namespace lanthorn
