// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Finds beams from a position or along a ray: photon beams for point–beam and beam–beam estimates (Jarosz,
// Nowrouzezahrai, Sadeghi & Jensen 2011).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/large_vector.h"
#include "base/prefetch.h"
#include "index/lattice.h"
#include "index/line_distance.h"
#include "index/point_index.h"
#include "index/wave.h"
#include "math/lanes.h"
#include "math/vec.h"

namespace lanthorn {

/// The points origin + s · direction with s in [0, length] (m), and the radius of the kernel across the beam (m).
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

/// The closest points of a ray and a beam; nullopt if they lie beyond an end, are too far apart, or do not exist.
inline std::optional<LineCrossing> crossing_of(const RaySegment& ray, const Beam& beam) {
  const auto c = closest_points(ray.origin, ray.direction, beam.origin, beam.direction);
  if (!c || c->t < ray.begin || c->t > ray.end || c->s < 0 || c->s > beam.length || c->dist2 > sqr(double{beam.radius}))
    return {};
  return c;
}

/// A bounding volume hierarchy of beams, which are cut into pieces. Pieces with similar starts and similar ends share a
/// leaf, and a node bounds its pieces by the convex hull of two boxes, one around their starts and one around their
/// ends. This gives tight bounds for bundles of long thin beams in any direction, whose boxes would overlap nearly
/// everything (compare the oriented boxes for hair of Woop et al. 2014). Bounds and pieces are rounded to lattices,
/// because searches are limited by memory. Bounds and a single-precision test exclude pieces that are clearly outside.
/// Double precision decides about the rest, and assigns each point to one piece. The result is the set of beams that
/// satisfy the conditions below, up to rounding of doubles. Beams have flat ends, so that a kernel across a beam has
/// the same integral at each of its points. Beams exactly on the boundary are included.
class BeamBvh {
 public:
  /// Beams must be finite, with lengths and radii >= 0 and directions of unit length up to rounding; fewer than 2^28.
  static IndexBuild<BeamBvh> build(std::span<const Beam> beams);

  /// Calls `visit(slot, s, dist2)` once for every beam onto whose line p projects at s in [0, length], with a squared
  /// distance of at most the beam's radius², in an order that depends only on the index and the query.
  template <class Visit>
  void for_each_around(const Point& p, Visit&& visit) const;

  /// Calls `visit(slot, const BeamCrossing&)` once for every beam for which the closest points of ray and beam, as
  /// lines, lie in [begin, end] and in [0, length], at a distance of at most the beam's radius. Ignores beams exactly
  /// parallel to the ray, which have no closest points.
  template <class Visit>
  void for_each_crossing(const RaySegment& ray, Visit&& visit) const;

  std::size_t size() const { return beams_.size(); }
  const Beam& beam(std::uint32_t slot) const { return beams_[slot]; }
  /// Memory of beams, pieces and bounds, bytes.
  std::size_t memory_bytes() const {
    return std::span(nodes_).size_bytes() + std::span(leaves_).size_bytes() + std::span(pieces_).size_bytes() +
           std::span(beams_).size_bytes();
  }

 private:
  /// The points of a beam with s in [begin, end). The last piece's end is infinite; empty pieces pad leaves.
  struct Piece {
    std::uint32_t slot = 0;
    float begin = infinity, end = infinity;

    bool contains(double s) const { return s >= begin && s < end; }
  };
  /// Eight pieces as segments.
  struct alignas(64) Leaf {
    LatticeSegments pieces;
    float reach = 0;  ///< maximum distance of the pieces' kernels from these segments
  };
  /// Boxes around the starts and the ends of pieces, enlarged by their reach.
  struct Hull {
    Bounds start, end;

    void extend(const Hull& other) {
      start.extend(other.start);
      end.extend(other.end);
    }
  };
  /// The bounds of at most eight consecutive leaves or nodes.
  struct alignas(64) Node {
    LatticeBoxes start, end;
    std::uint32_t first = 0;
    std::uint16_t count = 0;
    bool has_leaves = false;

    Node() = default;
    Node(std::span<const Hull> children, std::size_t first_child, bool of_leaves);
  };
  /// A ray broadcast to all lanes: a frame whose last axis is its direction.
  struct LaneRay {
    Point origin;
    LaneVec3 u, v, w;
    Lanes begin, end;
    Lanes slack;  ///< upper bound of the rounding errors of coordinates in the frame, as far as they depend on the ray

    explicit LaneRay(const RaySegment& ray);
  };

  class Builder;

  /// Distance of 0 from the convex hull of two intervals, given by centres and half widths.
  static Lanes outside(const Lanes& a, const Lanes& half_a, const Lanes& b, const Lanes& half_b) {
    return max(min(a - half_a, b - half_b), min(0.0f - a - half_a, 0.0f - b - half_b));
  }
  static std::uint32_t overlaps(const Node& node, const LaneRay& ray);
  static std::uint32_t overlaps(const Node& node, const Point& p, const Lanes& slack);
  static std::uint32_t passes_near(const Leaf& leaf, const LaneRay& ray);
  static std::uint32_t passes_near(const Leaf& leaf, const Point& p);

  template <class Overlaps, class Test, class Visit>
  void search(Overlaps&& overlaps, Test&& test, Visit&& visit) const;
  template <class Test, class Visit>
  void search_leaves(const Wave& found, Test&& test, Visit&& visit) const;

  LargeVector<Node> nodes_;  ///< the last one is the root
  LargeVector<Leaf> leaves_;
  LargeVector<Piece> pieces_;  ///< eight per leaf
  LargeVector<Beam> beams_;    ///< by slot
};

inline std::uint32_t BeamBvh::overlaps(const Node& node, const LaneRay& ray) {
  const LatticeBoxes::Lane start = node.start.from(ray.origin), end = node.end.from(ray.origin);
  const Lanes start_u = dot(start.centre, ray.u), start_v = dot(start.centre, ray.v);
  const Lanes end_u = dot(end.centre, ray.u), end_v = dot(end.centre, ray.v);
  // In the projection along the ray, which becomes the point 0: tests separating axes along and across the hull. Any
  // axis is valid; this one is not 0 where start and end coincide.
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

inline std::uint32_t BeamBvh::overlaps(const Node& node, const Point& p, const Lanes& slack) {
  const LatticeBoxes::Lane start = node.start.from(p), end = node.end.from(p);
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

/// As in `closest_points`, for a segment from w along e: |w·n| <= r |n| with n = d × e, plus a margin for the errors of
/// n and of w·n, which are below 2^-20 |e| and 2^-20 |w| |e|: (x + y)² <= (1 + 1/64) x² + 65 y².
inline std::uint32_t BeamBvh::passes_near(const Leaf& leaf, const LaneRay& ray) {
  const auto [w, e] = leaf.pieces.from(ray.origin);
  const LaneVec3 n = cross(ray.w, e);
  const Lanes wn = dot(w, n), radius2 = sqr(leaf.reach);
  return not_greater(
      wn * wn, (1.0f + 0x1p-6f) * (radius2 * dot(n, n)) + 65 * 0x1p-38f * ((dot(w, w) + radius2) * dot(e, e)) + 1e-36f);
}

/// |w × e| <= r |e|.
inline std::uint32_t BeamBvh::passes_near(const Leaf& leaf, const Point& p) {
  const auto [w, e] = leaf.pieces.from(p);
  const LaneVec3 across = cross(w, e);
  const Lanes radius2 = sqr(leaf.reach);
  return not_greater(dot(across, across),
                     ((1.0f + 0x1p-6f) * radius2 + 65 * 0x1p-38f * dot(w, w)) * dot(e, e) + 1e-36f);
}

/// Calls `visit(piece)` for each candidate, in an order that depends only on the index and the query. Returns one bit
/// per child of a node: `overlaps(node)`; one bit per piece of a leaf: `test(leaf)`.
template <class Overlaps, class Test, class Visit>
void BeamBvh::search(Overlaps&& overlaps, Test&& test, Visit&& visit) const {
  if (nodes_.empty()) return;
  search_in_waves(
      nodes_, static_cast<std::uint32_t>(nodes_.size() - 1),
      [&](std::uint32_t number, std::size_t) {
        const Node& node = nodes_[number];
        return WaveChildren{node.first, overlaps(node) & ((1u << node.count) - 1), node.has_leaves};
      },
      [&](const Wave& leaves) { search_leaves(leaves, test, visit); });
}

/// Processes all leaves, then all pieces, then all beams, so that each is prefetched before it is used.
template <class Test, class Visit>
void BeamBvh::search_leaves(const Wave& found, Test&& test, Visit&& visit) const {
  std::array<std::uint32_t, Wave::most * Lanes::width> places;
  std::size_t count = 0;
  found.for_each(leaves_, [&](std::uint32_t leaf) {
    for (std::uint32_t hit = test(leaves_[leaf]); hit != 0; hit &= hit - 1) {
      places[count] = leaf * Lanes::width + static_cast<std::uint32_t>(std::countr_zero(hit));
      prefetch(pieces_[places[count++]]);
    }
  });
  for (std::size_t i = 0; i < count; ++i) prefetch(beams_[pieces_[places[i]].slot]);
  for (std::size_t i = 0; i < count; ++i) visit(pieces_[places[i]]);
}

template <class Visit>
void BeamBvh::for_each_around(const Point& p, Visit&& visit) const {
  const Lanes slack = 2 * rounding_at(p);
  search([&](const Node& node) { return overlaps(node, p, slack); },
         [&](const Leaf& leaf) { return passes_near(leaf, p); },
         [&](const Piece& piece) {
           const Beam& beam = beams_[piece.slot];
           const FootPoint foot = foot_on_line(p, beam.origin, beam.direction);
           if (foot.t >= 0 && foot.t <= beam.length && foot.dist2 <= sqr(double{beam.radius}) && piece.contains(foot.t))
             visit(piece.slot, static_cast<float>(foot.t), static_cast<float>(foot.dist2));
         });
}

template <class Visit>
void BeamBvh::for_each_crossing(const RaySegment& ray, Visit&& visit) const {
  const LaneRay lanes(ray);
  search([&](const Node& node) { return overlaps(node, lanes); },
         [&](const Leaf& leaf) { return passes_near(leaf, lanes); },
         [&](const Piece& piece) {
           const Beam& beam = beams_[piece.slot];
           const std::optional<LineCrossing> c = crossing_of(ray, beam);
           if (c && piece.contains(c->s))
             visit(piece.slot, BeamCrossing{static_cast<float>(c->t), static_cast<float>(c->s),
                                            static_cast<float>(c->dist2), static_cast<float>(c->sin)});
         });
}

}  // namespace lanthorn
