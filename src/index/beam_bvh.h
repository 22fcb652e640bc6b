// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Beams, found from a position and along a ray: photon beams for point–beam and beam–beam estimates (Jarosz,
// Nowrouzezahrai, Sadeghi & Jensen 2011).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "index/lanes.h"
#include "index/leaf_tree.h"
#include "index/line_distance.h"
#include "index/point_index.h"
#include "math/vec.h"

namespace lanthorn {

/// The points origin + s · direction with s in [0, length] (m), and how far they are felt across (m).
struct Beam {
  Point origin{0};
  Direction direction{0, 0, 1};
  float length = 0;
  float radius = 0;
};

/// Where a ray passes a beam: parameters of the closest points of the two lines on ray and beam (m), their squared
/// distance (m²), and the sine of the angle between the lines.
struct BeamCrossing {
  float t, s, dist2, sin;
};

/// The closest points of a ray and a beam; nothing if they lie beyond an end, are too far apart, or do not exist.
inline std::optional<LineCrossing> crossing_of(const RaySegment& ray, const Beam& beam) {
  const auto c = closest_points(ray.origin, ray.direction, beam.origin, beam.direction);
  if (!c || c->t < ray.begin || c->t > ray.end || c->s < 0 || c->s > beam.length || c->dist2 > sqr(double{beam.radius}))
    return {};
  return c;
}

/// A bounding volume hierarchy of beams. Beams with like starts and like ends lie in one leaf, and a node bounds its
/// beams by the convex hull of two boxes, one around their starts and one around their ends: bundles of long thin beams
/// in all directions, whose boxes would overlap nearly everything, so have tight bounds (compare the oriented boxes for
/// hair of Woop et al. 2014). Long beams lie there in pieces, at most three to a beam in the mean. Bounds and a test in
/// single precision leave out what is clearly outside; double precision decides, and says which piece a point belongs
/// to. What is found so are the beams for which the conditions below hold, up to the rounding of doubles. Beams have
/// flat ends: a kernel across a beam has the same integral at each of its points. The boundary counts.
class BeamBvh {
 public:
  /// Beams must be finite, with lengths and radii >= 0 and directions of unit length up to rounding; fewer than 2^30.
  static IndexBuild<BeamBvh> build(std::span<const Beam> beams);

  /// Calls `visit(slot, s, dist2)` once for every beam on whose line the foot of p lies in [0, length], at s, and whose
  /// squared distance from there is at most the beam's radius², in an order that depends only on the index and the
  /// query.
  template <class Visit>
  void for_each_around(const Point& p, Visit&& visit) const;

  /// Calls `visit(slot, const BeamCrossing&)` once for every beam for which the closest points of ray and beam, as
  /// lines, lie in [begin, end] and in [0, length], and are not farther apart than the beam's radius. Never for beams
  /// exactly parallel to the ray, which have no closest points.
  template <class Visit>
  void for_each_crossing(const RaySegment& ray, Visit&& visit) const;

  std::size_t size() const { return first_pieces_.size(); }
  Beam beam(std::uint32_t slot) const {
    const std::uint32_t piece = first_pieces_[slot];
    return tree_.leaf_of(piece).beam(piece % Lanes::width);
  }
  /// Pieces and bounds, bytes.
  std::size_t memory_bytes() const { return tree_.memory_bytes() + std::span(first_pieces_).size_bytes(); }

 private:
  /// Piece `number` of the `count` equal ones of the beam at `slot`.
  struct Piece {
    std::uint32_t slot = 0;
    std::uint16_t number = 0, count = 1;

    /// True if the beam's point s is in this piece: of all pieces, in exactly one.
    bool contains(double s, float length) const {
      if (count == 1) return true;
      const double place = s * (static_cast<double>(count) / static_cast<double>(length));
      return static_cast<std::uint16_t>(std::min(place, static_cast<double>(count - 1))) == number;
    }
  };
  /// Pieces of beams, each with the whole beam: its line is what is tested.
  struct Leaf {
    StoredVec3 origin, direction;
    alignas(32) std::array<float, Lanes::width> radius, length;
    std::array<Piece, Lanes::width> piece;

    Beam beam(std::uint32_t lane) const {
      return {origin.lane(lane), direction.lane(lane), length[lane], radius[lane]};
    }
  };
  /// Boxes around the starts and the ends of beams, as far as they are felt.
  struct Hull {
    Bounds start, end;

    void extend(const Hull& other) {
      start.extend(other.start);
      end.extend(other.end);
    }
  };
  /// Boxes as centre and half extent.
  struct StoredBox {
    StoredVec3 centre, half;

    void set(std::uint32_t lane, const Bounds& box);
  };
  struct Node {
    using Bound = Hull;
    StoredBox start, end;

    void set(std::uint32_t lane, const Hull& hull) {
      start.set(lane, hull.start);
      end.set(lane, hull.end);
    }
  };
  /// A box in a moved frame.
  struct LaneBox {
    LaneVec3 centre, half;

    LaneBox(const StoredBox& box, const LaneVec3& origin) : centre(box.centre.load() - origin), half(box.half.load()) {}
  };
  /// A ray in lanes: its origin, and a frame around it whose last axis is its direction.
  struct LaneRay {
    LaneVec3 origin, u, v, w;
    Lanes begin, end;
    Lanes slack;  ///< more than rounding takes from coordinates in the frame, as far as it depends on the ray

    explicit LaneRay(const RaySegment& ray);
  };

  /// How far 0 is outside two intervals and what is between them, where centre and half width are given for both.
  static Lanes outside(const Lanes& a, const Lanes& half_a, const Lanes& b, const Lanes& half_b) {
    return max(min(a - half_a, b - half_b), min(0.0f - a - half_a, 0.0f - b - half_b));
  }
  static std::uint32_t overlaps(const Node& node, const LaneRay& ray);
  static std::uint32_t overlaps(const Node& node, const LaneVec3& p, const Lanes& slack);
  static std::uint32_t passes_near(const Leaf& leaf, const LaneRay& ray);
  static std::uint32_t passes_near(const Leaf& leaf, const LaneVec3& p);

  LeafTree<Node, Leaf> tree_;
  std::vector<std::uint32_t> first_pieces_;  ///< by slot, where the beam's first piece is in the tree
};

inline std::uint32_t BeamBvh::overlaps(const Node& node, const LaneRay& ray) {
  const LaneBox start(node.start, ray.origin), end(node.end, ray.origin);
  const Lanes start_u = dot(start.centre, ray.u), start_v = dot(start.centre, ray.v);
  const Lanes end_u = dot(end.centre, ray.u), end_v = dot(end.centre, ray.v);
  // Seen along the ray, which is the point 0: separating axes along the hull and across it. Any axis would do; this one
  // is not 0 where start and end coincide.
  const Lanes du = end_u - start_u + 1e-18f, dv = end_v - start_v;
  const auto gap = [&](const Lanes& a, const Lanes& b) {
    const LaneVec3 axis = abs(a * ray.u + b * ray.v);
    return outside(a * start_u + b * start_v, dot(axis, start.half), a * end_u + b * end_v, dot(axis, end.half)) -
           ray.slack * (abs(a) + abs(b));
  };
  const LaneVec3 along = abs(ray.w);
  const Lanes start_w = dot(start.centre, ray.w), end_w = dot(end.centre, ray.w);
  const Lanes start_half = dot(along, start.half), end_half = dot(along, end.half);
  const Lanes first = min(start_w - start_half, end_w - end_half), last = max(start_w + start_half, end_w + end_half);
  return not_greater(max(max(gap(du, dv), gap(0.0f - dv, du)), max(first - ray.end, ray.begin - last) - ray.slack),
                     0.0f);
}

inline std::uint32_t BeamBvh::overlaps(const Node& node, const LaneVec3& p, const Lanes& slack) {
  const LaneBox start(node.start, p), end(node.end, p);
  const LaneVec3 &a = start.centre, &b = end.centre, &half_a = start.half, &half_b = end.half;
  const LaneVec3 d = b - a;
  const auto across = [&](const Lanes& dx, const Lanes& dy, const Lanes& ax, const Lanes& ay, const Lanes& bx,
                          const Lanes& by, const Lanes& hax, const Lanes& hay, const Lanes& hbx, const Lanes& hby) {
    const Lanes ex = abs(dx), ey = abs(dy);
    return outside(dx * ay - dy * ax, ex * hay + ey * hax, dx * by - dy * bx, ex * hby + ey * hbx) - slack * (ex + ey);
  };
  const Lanes boxes = max(max(outside(a.x, half_a.x, b.x, half_b.x), outside(a.y, half_a.y, b.y, half_b.y)),
                          outside(a.z, half_a.z, b.z, half_b.z));
  const Lanes xy = across(d.x, d.y, a.x, a.y, b.x, b.y, half_a.x, half_a.y, half_b.x, half_b.y);
  const Lanes yz = across(d.y, d.z, a.y, a.z, b.y, b.z, half_a.y, half_a.z, half_b.y, half_b.z);
  const Lanes zx = across(d.z, d.x, a.z, a.x, b.z, b.x, half_a.z, half_a.x, half_b.z, half_b.x);
  return not_greater(max(max(boxes - slack, xy), max(yz, zx)), 0.0f);
}

/// As in `closest_points`: |w·n| <= r |n|, with room for errors of n and of w·n, which are less than 2^-20 and
/// 2^-20 |w|: (x + y)² <= (1 + 1/64) x² + 65 y².
inline std::uint32_t BeamBvh::passes_near(const Leaf& leaf, const LaneRay& ray) {
  const LaneVec3 w = leaf.origin.load() - ray.origin, n = cross(ray.w, leaf.direction.load());
  const Lanes wn = dot(w, n), radius(leaf.radius), radius2 = radius * radius;
  return not_greater(wn * wn,
                     (1.0f + 0x1p-6f) * (radius2 * dot(n, n)) + 65 * 0x1p-38f * (dot(w, w) + radius2) + 1e-36f);
}

inline std::uint32_t BeamBvh::passes_near(const Leaf& leaf, const LaneVec3& p) {
  const LaneVec3 w = p - leaf.origin.load(), direction = leaf.direction.load();
  const LaneVec3 across = w - dot(w, direction) * direction;
  const Lanes radius(leaf.radius);
  return not_greater(dot(across, across), (1.0f + 0x1p-6f) * (radius * radius) + 65 * 0x1p-40f * dot(w, w) + 1e-36f);
}

template <class Visit>
void BeamBvh::for_each_around(const Point& p, Visit&& visit) const {
  const LaneVec3 q{p.x, p.y, p.z};
  const Lanes slack = 0x1p-20f * (std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z));
  tree_.search([&](const Node& node) { return overlaps(node, q, slack); },
               [&](const Leaf& leaf) { return passes_near(leaf, q); },
               [&](std::uint32_t, const Leaf& leaf, std::uint32_t lane) {
                 const Beam beam = leaf.beam(lane);
                 const FootPoint foot = foot_on_line(p, beam.origin, beam.direction);
                 if (foot.t >= 0 && foot.t <= beam.length && foot.dist2 <= sqr(double{beam.radius}) &&
                     leaf.piece[lane].contains(foot.t, beam.length))
                   visit(leaf.piece[lane].slot, static_cast<float>(foot.t), static_cast<float>(foot.dist2));
               });
}

template <class Visit>
void BeamBvh::for_each_crossing(const RaySegment& ray, Visit&& visit) const {
  const LaneRay lanes(ray);
  tree_.search([&](const Node& node) { return overlaps(node, lanes); },
               [&](const Leaf& leaf) { return passes_near(leaf, lanes); },
               [&](std::uint32_t, const Leaf& leaf, std::uint32_t lane) {
                 const Beam beam = leaf.beam(lane);
                 const std::optional<LineCrossing> c = crossing_of(ray, beam);
                 if (c && leaf.piece[lane].contains(c->s, beam.length))
                   visit(leaf.piece[lane].slot, BeamCrossing{static_cast<float>(c->t), static_cast<float>(c->s),
                                                             static_cast<float>(c->dist2), static_cast<float>(c->sin)});
               });
}

}  // namespace lanthorn
