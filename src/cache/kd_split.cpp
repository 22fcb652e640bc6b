// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "cache/kd_split.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/parallel.h"

namespace lanthorn {

namespace {

/// Moves the points for which `first_side(coordinate)` to the front; returns how many. No branches: they would be
/// mispredicted half of the time.
template <class FirstSide>
std::size_t partition(std::span<NumberedPoint> points, int axis, FirstSide&& first_side) {
  std::size_t front = 0;
  for (NumberedPoint& p : points) {
    const NumberedPoint moved = p;
    p = points[front];
    points[front] = moved;
    front += static_cast<std::size_t>(first_side(moved.position[axis]));
  }
  return front;
}

/// An estimate of the coordinate at `rank`, from evenly spaced samples; always a coordinate of one of the points.
float estimate(std::span<const NumberedPoint> points, std::size_t rank, int axis) {
  constexpr std::size_t samples = 64;
  std::array<float, samples> sample;
  for (std::size_t i = 0; i < samples; ++i)
    sample[i] = points[(2 * i + 1) * points.size() / (2 * samples)].position[axis];
  const auto at = sample.begin() + static_cast<std::ptrdiff_t>(rank * samples / points.size());
  std::nth_element(sample.begin(), at, sample.end());
  return *at;
}

}  // namespace

std::unique_ptr<NumberedPoint[]> numbered(std::span<const Point> points) {
  auto all = std::make_unique_for_overwrite<NumberedPoint[]>(points.size());
  parallel_chunks(points.size(), 1u << 15, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) all[i] = {points[i], static_cast<std::uint32_t>(i)};
  });
  return all;
}

int split_axis(std::span<const NumberedPoint> points, SplitRule rule) {
  Vec3 spread;
  if (rule == SplitRule::largest_extent) {
    Bounds bounds;
    for (const NumberedPoint& p : points) bounds.extend(p.position);
    spread = bounds.extent();
  } else {
    glm::dvec3 sum(0), squares(0);
    for (const NumberedPoint& p : points) {
      const glm::dvec3 d(p.position - points[0].position);
      sum += d;
      squares += d * d;
    }
    spread = Vec3(squares - sum * sum / static_cast<double>(points.size()));
  }
  const int larger = spread.y > spread.x ? 1 : 0;
  return spread.z > spread[larger] ? 2 : larger;
}

void select_rank(std::span<NumberedPoint> points, std::size_t rank, int axis) {
  constexpr std::size_t small = 128;
  while (points.size() > small) {
    const float pivot = estimate(points, rank, axis);
    const std::size_t less = partition(points, axis, [pivot](float x) { return x < pivot; });
    if (rank < less) {
      points = points.first(less);
      continue;
    }
    points = points.subspan(less);
    rank -= less;
    const std::size_t equal = partition(points, axis, [pivot](float x) { return x <= pivot; });
    if (rank < equal) return;
    points = points.subspan(equal);
    rank -= equal;
  }
  std::nth_element(
      points.begin(), points.begin() + static_cast<std::ptrdiff_t>(rank), points.end(),
      [axis](const NumberedPoint& a, const NumberedPoint& b) { return a.position[axis] < b.position[axis]; });
}

}  // namespace lanthorn
