// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "math/vec.h"
#include "medium/flight.h"

namespace lanthorn {

/// Upper bounds of a density on a coarse grid over a box, outside of which the density is 0. Tracking takes long steps
/// where the medium is thin.
class MajorantGrid {
 public:
  static constexpr int resolution = 16;

  MajorantGrid() = default;
  /// `bound(cell)`: upper bound of the density inside the cell, a box in the medium's space.
  template <class Bound>
  MajorantGrid(const Bounds& box, Bound&& bound) : box_(box), values_(resolution * resolution * resolution) {
    std::size_t i = 0;
    for (int z = 0; z < resolution; ++z)
      for (int y = 0; y < resolution; ++y)
        for (int x = 0; x < resolution; ++x) values_[i++] = bound(Bounds{corner(x, y, z), corner(x + 1, y + 1, z + 1)});
  }

  const Bounds& box() const { return box_; }

  /// Calls `visit(t0, t1, majorant)` for the pieces of the segment inside the box, in order, until it returns false.
  /// The segment is in the medium's space; t is in units of its direction, which need not have unit length.
  template <class Visit>
  void for_each_piece(const Segment& segment, Visit&& visit) const;

 private:
  Point corner(int x, int y, int z) const {
    const Vec3 f = Vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) / float{resolution};
    return box_.min + f * box_.extent();
  }

  struct Overlap {
    float begin = 0, end = 0;
  };
  /// Interval of the segment inside the box.
  std::optional<Overlap> overlap_with(const Segment& segment) const {
    Overlap o{0, segment.length};
    for (int axis = 0; axis < 3; ++axis) {
      const float origin = segment.origin[axis], d = segment.direction[axis];
      if (d == 0) {
        if (origin < box_.min[axis] || origin > box_.max[axis]) return {};
        continue;
      }
      const float a = (box_.min[axis] - origin) / d, b = (box_.max[axis] - origin) / d;
      o.begin = std::max(o.begin, std::min(a, b));
      o.end = std::min(o.end, std::max(a, b));
    }
    return o.begin < o.end ? std::optional(o) : std::nullopt;
  }

  Bounds box_{Point(0), Point(0)};
  std::vector<float> values_;
};

template <class Visit>
void MajorantGrid::for_each_piece(const Segment& segment, Visit&& visit) const {
  const std::optional<Overlap> overlap = overlap_with(segment);
  if (!overlap) return;
  float t = overlap->begin;
  const float t_end = overlap->end;
  const Vec3 cell = box_.extent() / float{resolution};

  // Grid traversal of Amanatides & Woo 1987.
  const Point start = segment.origin + t * segment.direction;
  std::array<int, 3> at{}, step{};
  Vec3 next(infinity), stride(infinity);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<unsigned>(axis);
    const float d = segment.direction[axis];
    at[a] = std::clamp(static_cast<int>((start[axis] - box_.min[axis]) / cell[axis]), 0, resolution - 1);
    if (d == 0) continue;
    step[a] = d > 0 ? 1 : -1;
    stride[axis] = cell[axis] / std::fabs(d);
    const float border = box_.min[axis] + static_cast<float>(at[a] + (d > 0 ? 1 : 0)) * cell[axis];
    next[axis] = (border - segment.origin[axis]) / d;
  }
  while (t < t_end) {
    const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const auto a = static_cast<unsigned>(axis);
    const float t1 = std::min(next[axis], t_end);
    const int index = (at[2] * resolution + at[1]) * resolution + at[0];
    if (t1 > t && !visit(t, t1, values_[static_cast<std::size_t>(index)])) return;
    t = std::max(t, t1);
    at[a] += step[a];
    if (at[a] < 0 || at[a] >= resolution) return;
    next[axis] += stride[axis];
  }
}

}  // namespace lanthorn
