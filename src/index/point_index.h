// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What every point index offers. An index knows positions and nothing else: it numbers the points by *slot*, its own
// storage order, and tells at build time which input point went where, so that the owner can store its records in the
// same order and a query reads contiguous memory.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

/// One found point: squared distance to the query (m²) and the slot of the point.
struct Neighbour {
  float dist2;
  std::uint32_t slot;

  friend bool operator<(const Neighbour& a, const Neighbour& b) { return a.dist2 < b.dist2; }
};

/// What `Index::build(points, ...)` returns: the index, and for each slot the number of the input point stored there.
template <class Index>
struct IndexBuild {
  Index index;
  std::vector<std::uint32_t> order;
};

/// `for_each_near(p, radius, visit)` calls `visit(slot, dist2)` once for every point with dist2 <= radius², in an order
/// that depends on the index and the query alone. Points exactly on the boundary count.
template <class I>
concept PointIndex = requires(const I i, const Point p, std::uint32_t slot) {
  i.for_each_near(p, 1.0f, [](std::uint32_t, float) {});
  { i.size() } -> std::convertible_to<std::size_t>;
  { i.position(slot) } -> std::convertible_to<Point>;
  { i.memory_bytes() } -> std::convertible_to<std::size_t>;
};

/// `nearest(p, max_radius, heap)` finds the heap.size() nearest points with dist2 <= max_radius² and returns the filled
/// front part of `heap` as a max-heap on dist2 (the farthest first); shorter than `heap` when there are not as many.
/// It never allocates. Which of several points at exactly the k-th distance are found is up to the index.
template <class I>
concept NearestIndex = PointIndex<I> && requires(const I i, const Point p, std::span<Neighbour> heap) {
  { i.nearest(p, 1.0f, heap) } -> std::same_as<std::span<const Neighbour>>;
};

}  // namespace lanthorn
