// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Finds points with individual radii from a position or along a ray: photons in media for estimates at a point (Jensen
// & Christensen 1998) and for the beam radiance estimate (Jarosz, Zwicker & Jensen 2008).
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "index/leaf_tree.h"
#include "index/line_distance.h"
#include "index/point_index.h"
#include "index/slot_points.h"
#include "math/lanes.h"
#include "math/vec.h"

namespace lanthorn {

/// A bounding volume hierarchy of balls. Boxes and a single-precision test exclude balls that are clearly outside;
/// double precision decides about the rest. The result is the set of balls that satisfy the conditions below, up to
/// rounding of doubles. Balls exactly on the boundary are included.
class BallBvh {
 public:
  /// Balls must be finite, with radii >= 0, fewer than 2^32.
  static IndexBuild<BallBvh> build(std::span<const Ball> balls);
  /// All balls have the same radius.
  static IndexBuild<BallBvh> build(std::span<const Point> centres, float radius);

  /// Calls `visit(slot, dist2)` once for every ball that contains p, with the squared distance of its centre, in an
  /// order that depends only on the index and the query.
  template <class Visit>
  void for_each_containing(const Point& p, Visit&& visit) const;

  /// Calls `visit(slot, t, dist2)` once for every ball whose centre projects onto the ray at t in [begin, end], with a
  /// squared distance of at most its radius². These are discs that face the ray: nothing is found beyond the segment's
  /// ends, where an estimate across the ray would overestimate.
  template <class Visit>
  void for_each_along(const RaySegment& ray, Visit&& visit) const;

  std::size_t size() const { return tree_.size(); }
  Ball ball(std::uint32_t slot) const { return tree_.leaf_of(slot).ball(slot % Lanes::width); }
  Point position(std::uint32_t slot) const { return ball(slot).centre; }
  /// Memory of balls and boxes, bytes.
  std::size_t memory_bytes() const { return tree_.memory_bytes(); }

 private:
  struct Leaf {
    StoredVec3 centre;
    alignas(32) std::array<float, Lanes::width> radius;

    Ball ball(std::uint32_t lane) const { return {centre.lane(lane), radius[lane]}; }
  };
  struct Node {
    using Bound = Bounds;
    StoredVec3 low, high;

    Node() = default;
    explicit Node(std::span<const Bounds> children);
  };

  template <class BallOf>
  static IndexBuild<BallBvh> build_from(std::size_t count, BallOf&& ball_of);

  LeafTree<Node, Leaf> tree_;
};

template <class Visit>
void BallBvh::for_each_containing(const Point& p, Visit&& visit) const {
  const LaneVec3 q{p.x, p.y, p.z};
  const auto overlaps = [&](const Node& node) {
    const LaneVec3 low = node.low.load() - q, high = q - node.high.load();
    return not_greater(max(max(max(low.x, low.y), low.z), max(max(high.x, high.y), high.z)), 0.0f);
  };
  const auto test = [&](const Leaf& leaf) {
    const LaneVec3 w = leaf.centre.load() - q;
    const Lanes reach = Lanes(leaf.radius) * (1.0f + 0x1p-20f) + 1e-18f;
    return not_greater(dot(w, w), reach * reach);
  };
  tree_.search(overlaps, test, [&](std::uint32_t slot) {
    const Ball ball = this->ball(slot);
    const glm::dvec3 between = glm::dvec3(ball.centre) - glm::dvec3(p);
    const double dist2 = dot(between, between);
    if (dist2 <= sqr(double{ball.radius})) visit(slot, static_cast<float>(dist2));
  });
}

template <class Visit>
void BallBvh::for_each_along(const RaySegment& ray, Visit&& visit) const {
  const Point& o = ray.origin;
  const Direction& d = ray.direction;
  // Slab test (Kay & Kajiya 1986). A direction component of 0 is replaced by one so small that no finite ray leaves a
  // slab; boxes are never flat. `far` is enlarged by the maximum rounding error (Ize 2013).
  const auto inverse = [](float x) { return std::fabs(x) < 1e-28f ? std::copysign(1e28f, x) : 1 / x; };
  const Vec3 inv(inverse(d.x), inverse(d.y), inverse(d.z));
  const LaneVec3 origin{o.x, o.y, o.z}, direction{d.x, d.y, d.z};
  const auto overlaps = [&](const Node& node) {
    const LaneVec3 low = node.low.load() - origin, high = node.high.load() - origin;
    const Lanes x0 = low.x * inv.x, x1 = high.x * inv.x, y0 = low.y * inv.y, y1 = high.y * inv.y;
    const Lanes z0 = low.z * inv.z, z1 = high.z * inv.z;
    const Lanes near = max(max(min(x0, x1), min(y0, y1)), min(z0, z1));
    const Lanes far = min(min(max(x0, x1), max(y0, y1)), max(z0, z1));
    const Lanes slack = 0x1p-20f * max(abs(near), abs(far));
    return not_greater(max(near - slack, ray.begin), min(far + slack, ray.end));
  };
  const auto test = [&](const Leaf& leaf) {
    const LaneVec3 w = leaf.centre.load() - origin;
    const LaneVec3 across = w - dot(w, direction) * direction;
    // (r + 2^-20 |w|)² <= (1 + 1/64) r² + 65 · 2^-40 |w|²: 2^-20 |w| exceeds the error of `across`.
    const Lanes radius(leaf.radius);
    return not_greater(dot(across, across), (1.0f + 0x1p-6f) * (radius * radius) + 65 * 0x1p-40f * dot(w, w) + 1e-36f);
  };
  tree_.search(overlaps, test, [&](std::uint32_t slot) {
    const Ball ball = this->ball(slot);
    const FootPoint foot = foot_on_line(ball.centre, o, d);
    if (foot.dist2 <= sqr(double{ball.radius}) && foot.t >= ray.begin && foot.t <= ray.end)
      visit(slot, static_cast<float>(foot.t), static_cast<float>(foot.dist2));
  });
}

}  // namespace lanthorn
