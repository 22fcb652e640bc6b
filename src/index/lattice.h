// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Coordinates quantised to steps from a corner. This reduces the data that a search reads to a third, and searches are
// limited by memory.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "math/lanes.h"
#include "math/vec.h"

namespace lanthorn {

inline float sum_of_sizes(const Point& p) { return std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z); }
/// Upper bound of the rounding errors of the point's coordinates in a translated and rotated frame.
inline float rounding_at(const Point& p) { return 0x1p-19f * sum_of_sizes(p); }

/// The points corner + step · (i, j, k) (m), with integers up to the largest of type `Whole`.
template <class Whole>
struct Lattice {
  static constexpr auto last = std::numeric_limits<Whole>::max();

  Point corner{0};
  float step = 0;

  Lattice() = default;
  /// Spans the box.
  explicit Lattice(const Bounds& box) : corner(box.min) {
    const Vec3 extent = box.max - box.min;
    step = std::max({extent.x, extent.y, extent.z}) * (1 + 0x1p-20f) / static_cast<float>(last);
  }

  /// 0 for boxes too small for any query to resolve.
  float steps_per_metre() const { return step > 1e-30f ? 1 / step : 0.0f; }
  static Whole whole(float place) { return static_cast<Whole>(std::clamp(place, 0.0f, static_cast<float>(last))); }
};

/// Eight lattice points, in steps.
template <class Whole>
struct LatticePoints {
  std::array<std::array<Whole, Lanes::width>, 3> axis;

  LaneVec3 load() const { return {Lanes(axis[0]), Lanes(axis[1]), Lanes(axis[2])}; }
  /// Rounds down.
  void set(std::size_t lane, const Vec3& steps) {
    axis[0][lane] = Lattice<Whole>::whole(steps.x);
    axis[1][lane] = Lattice<Whole>::whole(steps.y);
    axis[2][lane] = Lattice<Whole>::whole(steps.z);
  }
};

/// Eight boxes. Rounding enlarges each on each side by at most 1/255 of the extent of all of them, and by more than the
/// rounding errors of coordinates in a transformed frame, as far as they depend on the boxes.
class LatticeBoxes {
 public:
  LatticeBoxes() = default;
  /// `box_of(child)` returns the box of a child; at most eight children.
  template <class Child, class BoxOf>
  LatticeBoxes(std::span<const Child> children, BoxOf&& box_of) {
    Bounds all;
    for (const Child& child : children) all.extend(box_of(child));
    const Vec3 extent = all.max - all.min;
    const Vec3 room(0x1p-15f * std::max({extent.x, extent.y, extent.z}) + rounding_at(all.min) + rounding_at(all.max) +
                    1e-18f);
    lattice_ = Lattice<std::uint8_t>({all.min - 2.0f * room, all.max + 2.0f * room});
    const float scale = lattice_.steps_per_metre();
    for (std::size_t lane = 0; lane < children.size(); ++lane) {
      const Bounds box = box_of(children[lane]);
      const Vec3 low = scale * (box.min - room - lattice_.corner), high = scale * (box.max + room - lattice_.corner);
      low_.set(lane, glm::floor(low));
      high_.set(lane, glm::ceil(high));
    }
  }

  /// Centres relative to `origin`, and half extents.
  struct Lane {
    LaneVec3 centre, half;
  };
  Lane from(const Point& origin) const {
    const LaneVec3 low = low_.load(), high = high_.load();
    const Vec3 moved = lattice_.corner - origin;
    const Lanes step = 0.5f * lattice_.step;
    return {step * (low + high) + LaneVec3{moved.x, moved.y, moved.z}, step * (high - low)};
  }

 private:
  Lattice<std::uint8_t> lattice_;
  LatticePoints<std::uint8_t> low_{}, high_{};
};

/// Eight segments, given by their ends, rounded to a lattice.
class LatticeSegments {
 public:
  LatticeSegments() = default;
  explicit LatticeSegments(const Bounds& box) : lattice_(box) {}

  void set(std::size_t lane, const Point& a, const Point& b) {
    const float scale = lattice_.steps_per_metre();
    first_.set(lane, scale * (a - lattice_.corner) + Vec3(0.5f));
    last_.set(lane, scale * (b - lattice_.corner) + Vec3(0.5f));
  }
  /// Upper bound (m) of the displacement of the segments' points by rounding: half a step along each axis, plus
  /// single-precision errors, including those of coordinates in a transformed frame.
  float error() const { return 1.0625f * lattice_.step; }

  /// First ends relative to `origin`, and vectors to the other ends, in an arbitrary unit.
  struct Lane {
    LaneVec3 start, along;
  };
  Lane from(const Point& origin) const {
    const LaneVec3 first = first_.load(), last = last_.load();
    const Vec3 moved = lattice_.corner - origin;
    return {Lanes(lattice_.step) * first + LaneVec3{moved.x, moved.y, moved.z}, 0x1p-16f * (last - first)};
  }

 private:
  Lattice<std::uint16_t> lattice_;
  LatticePoints<std::uint16_t> first_{}, last_{};
};

}  // namespace lanthorn
