// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What both kd-trees need to be built: the choice of an axis, and the split along it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "math/vec.h"

namespace lanthorn {

/// Along which axis a kd-tree splits a node.
enum class SplitRule : std::uint8_t {
  largest_extent,    ///< of the bounds of the node's points
  largest_variance,  ///< of the coordinates of the node's points
};

/// Coordinates that are read by axis: glm's operator[] branches.
using Coordinates = std::array<float, 3>;
inline Coordinates coordinates_of(const Point& p) { return {p.x, p.y, p.z}; }
inline Point point_of(const Coordinates& c) { return {c[0], c[1], c[2]}; }

/// A point and the number it has in the input. Aligned to be moved as one.
struct alignas(16) NumberedPoint {
  Coordinates position;
  std::uint32_t number;
};

/// The points with their numbers, in input order.
std::unique_ptr<NumberedPoint[]> numbered(std::span<const Point> points);

/// The axis (0, 1, 2) to split `points` along; there must be at least one.
unsigned split_axis(std::span<const NumberedPoint> points, SplitRule rule);

/// Reorders the points so that the coordinates along `axis` of those before `rank` are <= that of the one at `rank`,
/// and those behind it are >= it.
void split_at(std::span<NumberedPoint> points, std::size_t rank, unsigned axis);

}  // namespace lanthorn
