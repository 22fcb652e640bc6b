// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

/// A growing octree of spheres that finds the spheres around a point. A sphere is stored in all nodes, at most eight,
/// that its box overlaps at the level whose nodes are one to two of its diameters wide (Ward et al. 1988). A query for
/// a point follows a single path from the root; it may also return spheres that do not contain the point. Any number of
/// threads may query while nothing is inserted.
class SphereOctree {
 public:
  SphereOctree() = default;
  /// An octree for spheres in `bounds`. The bounds need not be exact: outer nodes extend to infinity.
  explicit SphereOctree(const Bounds& bounds)
      : centre_(bounds.centre()), half_(0.5f * max_component(bounds.extent())), nodes_(1) {}

  void insert(std::uint32_t id, const Point& centre, float radius) { insert(0, {centre_, half_}, id, centre, radius); }

  /// Calls `visit(id)` for every sphere that contains the point, and possibly for other spheres, in an order that
  /// depends only on the insertions.
  template <class Visit>
  void for_each_around(const Point& p, Visit&& visit) const {
    Cube cube{centre_, half_};
    std::uint32_t node = 0;
    do {
      for (const std::uint32_t id : nodes_[node].spheres) visit(id);
      const unsigned child =
          (p.x >= cube.centre.x ? 1u : 0u) | (p.y >= cube.centre.y ? 2u : 0u) | (p.z >= cube.centre.z ? 4u : 0u);
      node = nodes_[node].children[child];
      cube = cube.child(child);
    } while (node != 0);
  }

  /// Calls `visit(id)` for every sphere whose centre lies within `radius` of the point; some spheres are visited
  /// several times.
  template <class Visit>
  void for_each_near(const Point& p, float radius, Visit&& visit) const {
    visit_near(0, {centre_, half_}, p, radius, visit);
  }

 private:
  struct Node {
    std::array<std::uint32_t, 8> children{};  // 0: no child
    std::vector<std::uint32_t> spheres;
  };
  struct Cube {
    Point centre{0};
    float half = 0;

    // Bits 0, 1, 2 of `index`: upper half in x, y, z.
    Cube child(unsigned index) const {
      const float q = 0.5f * half;
      return {centre + Vec3(index & 1u ? q : -q, index & 2u ? q : -q, index & 4u ? q : -q), q};
    }
    // True if a sphere's box overlaps that child, whose outer sides extend to infinity.
    bool meets(unsigned index, const Point& p, float radius) const {
      for (int axis = 0; axis < 3; ++axis)
        if ((index >> axis & 1u) != 0 ? p[axis] + radius < centre[axis] : p[axis] - radius >= centre[axis])
          return false;
      return true;
    }
  };

  void insert(std::uint32_t node, const Cube& cube, std::uint32_t id, const Point& centre, float radius) {
    constexpr float least = 0x1p-20f;  // relative to the root; bounds the depth for tiny spheres
    if (cube.half < 2 * radius || cube.half < least * half_) {
      nodes_[node].spheres.push_back(id);
      return;
    }
    for (unsigned child = 0; child < 8; ++child) {
      if (!cube.meets(child, centre, radius)) continue;
      if (nodes_[node].children[child] == 0) {
        nodes_[node].children[child] = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
      }
      insert(nodes_[node].children[child], cube.child(child), id, centre, radius);
    }
  }

  template <class Visit>
  void visit_near(std::uint32_t node, const Cube& cube, const Point& p, float radius, Visit& visit) const {
    for (const std::uint32_t id : nodes_[node].spheres) visit(id);
    for (unsigned child = 0; child < 8; ++child)
      if (const std::uint32_t next = nodes_[node].children[child]; next != 0 && cube.meets(child, p, radius))
        visit_near(next, cube.child(child), p, radius, visit);
  }

  Point centre_{0};
  float half_ = 0;
  std::vector<Node> nodes_;
};

}  // namespace lanthorn
