// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "math/vec.h"
#include "medium/flight.h"

namespace lanthorn {

/// A value for each block of a coarse grid over a box, 0 outside the box. Holds majorants of a density, so that
/// tracking takes long steps where the medium is thin, or the density of sampled points.
class BlockGrid {
 public:
  BlockGrid() = default;
  /// `resolution` blocks along each axis; all values 0.
  BlockGrid(const Bounds& box, int resolution)
      : box_(box), resolution_(resolution), values_(static_cast<std::size_t>(resolution * resolution * resolution)) {}
  /// `value(block)` of each block, a box in the medium's space.
  template <class Value>
  BlockGrid(const Bounds& box, int resolution, Value&& value) : BlockGrid(box, resolution) {
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = value(block(i));
  }

  const Bounds& box() const { return box_; }
  int resolution() const { return resolution_; }
  /// x runs fastest.
  std::span<float> values() { return values_; }
  float value(std::size_t i) const { return values_[i]; }
  Bounds block(std::size_t i) const {
    const auto n = static_cast<std::size_t>(resolution_);
    const int x = static_cast<int>(i % n), y = static_cast<int>(i / n % n), z = static_cast<int>(i / (n * n));
    return {corner(x, y, z), corner(x + 1, y + 1, z + 1)};
  }

  /// Calls `visit(t0, t1, value)` for the pieces of the segment inside the box, in order, until it returns false. The
  /// segment is in the medium's space; t is in units of its direction, which need not have unit length.
  template <class Visit>
  void for_each_piece(const Segment& segment, Visit&& visit) const;

 private:
  Point corner(int x, int y, int z) const {
    const Vec3 f =
        Vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) / static_cast<float>(resolution_);
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
  int resolution_ = 0;
  std::vector<float> values_;
};

template <class Visit>
void BlockGrid::for_each_piece(const Segment& segment, Visit&& visit) const {
  const std::optional<Overlap> overlap = overlap_with(segment);
  if (!overlap) return;
  float t = overlap->begin;
  const float t_end = overlap->end;
  const Vec3 cell = box_.extent() / static_cast<float>(resolution_);

  // Grid traversal of Amanatides & Woo 1987.
  const Point start = segment.origin + t * segment.direction;
  std::array<int, 3> at{}, step{};
  Vec3 next(infinity), stride(infinity);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<unsigned>(axis);
    const float d = segment.direction[axis];
    at[a] = std::clamp(static_cast<int>((start[axis] - box_.min[axis]) / cell[axis]), 0, resolution_ - 1);
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
    const int index = (at[2] * resolution_ + at[1]) * resolution_ + at[0];
    if (t1 > t && !visit(t, t1, values_[static_cast<std::size_t>(index)])) return;
    t = std::max(t, t1);
    at[a] += step[a];
    if (at[a] < 0 || at[a] >= resolution_) return;
    next[axis] += stride[axis];
  }
}

}  // namespace lanthorn
