// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Common parts of both kd-tree builders: the choice of the split axis, and the split.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "math/vec.h"

namespace lanthorn {

/// How a kd-tree chooses the axis along which it splits a node.
enum class SplitRule : std::uint8_t {
  largest_extent,    ///< the longest axis of the bounds of the node's points
  largest_variance,  ///< the axis along which the node's points have the largest variance
};

/// Coordinates indexed by axis, because glm's operator[] branches.
using Coordinates = std::array<float, 3>;
inline Coordinates coordinates_of(const Point& p) { return {p.x, p.y, p.z}; }
inline Point point_of(const Coordinates& c) { return {c[0], c[1], c[2]}; }

/// A point and its number in the input. Aligned so that it is moved as one unit.
struct alignas(16) NumberedPoint {
  Coordinates position;
  std::uint32_t number;
};

/// The points with their numbers, in input order.
std::unique_ptr<NumberedPoint[]> numbered(std::span<const Point> points);

/// The axis (0, 1, 2) along which to split `points`; at least one point.
unsigned split_axis(std::span<const NumberedPoint> points, SplitRule rule);

/// Reorders the points by their coordinate along `axis`: points before `rank` have coordinates <= the one of the point
/// at `rank`, points behind it >=.
void split_at(std::span<NumberedPoint> points, std::size_t rank, unsigned axis);

}  // namespace lanthorn
