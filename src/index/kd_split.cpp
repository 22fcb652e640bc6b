// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "index/kd_split.h"

#include <algorithm>

#include "base/parallel.h"
#include "index/select_rank.h"

namespace lanthorn {

std::unique_ptr<NumberedPoint[]> numbered(std::span<const Point> points) {
  auto all = std::make_unique_for_overwrite<NumberedPoint[]>(points.size());
  parallel_chunks(points.size(), 1u << 15, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) all[i] = {coordinates_of(points[i]), static_cast<std::uint32_t>(i)};
  });
  return all;
}

unsigned split_axis(std::span<const NumberedPoint> points, SplitRule rule) {
  Vec3 spread;
  if (rule == SplitRule::largest_extent) {
    Bounds bounds;
    for (const NumberedPoint& p : points) bounds.extend(point_of(p.position));
    spread = bounds.extent();
  } else {
    glm::dvec3 sum(0), squares(0);
    for (const NumberedPoint& p : points) {
      const glm::dvec3 d(point_of(p.position) - point_of(points[0].position));
      sum += d;
      squares += d * d;
    }
    spread = Vec3(squares - sum * sum / static_cast<double>(points.size()));
  }
  const unsigned larger = spread.y > spread.x ? 1 : 0;
  return spread.z > std::max(spread.x, spread.y) ? 2 : larger;
}

void split_at(std::span<NumberedPoint> points, std::size_t rank, unsigned axis) {
  select_rank(points, rank, [axis](const NumberedPoint& p) { return p.position[axis]; });
}

}  // namespace lanthorn
