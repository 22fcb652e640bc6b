// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Interface of all point indices. An index stores only positions. It numbers the points by *slot*, its own storage
// order, and `build` returns the input point of every slot, so that the owner can store its records in the same order
// and a query reads contiguous memory.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

/// A point and a radius (m).
struct Ball {
  Point centre;
  float radius;
};

/// A point found: squared distance to the query (m²) and its slot.
struct Neighbour {
  float dist2;
  std::uint32_t slot;

  friend bool operator<(const Neighbour& a, const Neighbour& b) { return a.dist2 < b.dist2; }
};

/// Result of `Index::build(points, ...)`: the index, and for each slot the number of the input point stored there.
template <class Index>
struct IndexBuild {
  Index index;
  std::vector<std::uint32_t> order;
};

/// `for_each_near(p, radius, visit)` calls `visit(slot, dist2)` once for every point with dist2 <= radius², in an order
/// that depends only on the index and the query. Points exactly on the boundary are included.
template <class I>
concept PointIndex = requires(const I i, const Point p, std::uint32_t slot) {
  i.for_each_near(p, 1.0f, [](std::uint32_t, float) {});
  { i.size() } -> std::convertible_to<std::size_t>;
  { i.position(slot) } -> std::convertible_to<Point>;
  { i.memory_bytes() } -> std::convertible_to<std::size_t>;
};

/// `nearest(p, max_radius, heap)` finds the heap.size() nearest points with dist2 <= max_radius². It returns the filled
/// front part of `heap` as a max-heap on dist2 (the farthest first), shorter than `heap` if there are fewer points. It
/// never allocates. Among several points at exactly the k-th distance, the index may choose any.
template <class I>
concept NearestIndex = PointIndex<I> && requires(const I i, const Point p, std::span<Neighbour> heap) {
  { i.nearest(p, 1.0f, heap) } -> std::same_as<std::span<const Neighbour>>;
};

}  // namespace lanthorn
