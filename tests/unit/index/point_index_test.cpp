// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "index/bucket_kdtree.h"
#include "index/hash_grid.h"
#include "index/left_balanced_kdtree.h"
#include "math/hash.h"

namespace lanthorn::point_index_test {
namespace {

static_assert(PointIndex<HashGrid>);
static_assert(NearestIndex<BucketKdTree>);
static_assert(NearestIndex<LeftBalancedKdTree>);

struct PointSet {
  std::string name;
  std::vector<Point> points;
  float scale;  ///< a radius that finds some of the points
};

Point random_point(HashRng& rng) { return {rng.next(), rng.next(), rng.next()}; }

std::vector<Point> lattice(int side, float spacing) {
  std::vector<Point> points;
  for (int i = 0; i < side * side * side; ++i)
    points.push_back(spacing * Point(static_cast<float>(i % side), static_cast<float>(i / side % side),
                                     static_cast<float>(i / side / side)));
  return points;
}

std::vector<PointSet> point_sets() {
  HashRng rng(7);
  const auto generate = [&rng](std::size_t count, auto&& point) {
    std::vector<Point> points(count);
    for (Point& p : points) p = point(rng);
    return points;
  };
  const auto cluster = [](HashRng& r) {
    const float spread = std::exp2(-20 * r.next());
    return Point(0.25f, 0.5f, 0.75f) + spread * (random_point(r) - Point(0.5f));
  };
  const auto line = [](HashRng& r) {
    const float t = r.next();
    return Point(1 + t, 2 - t, 3 + 2 * t);
  };
  std::vector<PointSet> sets;
  sets.push_back({"none", {}, 0.1f});
  sets.push_back({"one", {{1, 2, 3}}, 0.1f});
  sets.push_back({"random", generate(3000, random_point), 0.1f});
  sets.push_back({"clustered", generate(3000, cluster), 0.01f});
  sets.push_back({"collinear", generate(2000, line), 0.05f});
  sets.push_back({"along x", generate(2000, [](HashRng& r) { return Point(r.next(), 4, 5); }), 0.01f});
  sets.push_back({"plane", generate(3000, [](HashRng& r) { return Point(r.next(), -1, r.next()); }), 0.03f});
  sets.push_back({"all equal", std::vector<Point>(500, Point(0.1f, 0.2f, 0.3f)), 0.1f});
  sets.push_back({"duplicates", generate(2000, [](HashRng& r) { return glm::floor(4.0f * random_point(r)); }), 1.0f});
  sets.push_back({"lattice", lattice(12, 1), 2.0f});
  sets.push_back({"huge", generate(2000, [](HashRng& r) { return 1e9f * (random_point(r) - Point(0.5f)); }), 1e8f});
  sets.push_back(
      {"far away", generate(2000, [](HashRng& r) { return Point(1e7f) + 100.0f * random_point(r); }), 10.0f});
  sets.push_back({"tiny", generate(2000, [](HashRng& r) { return 1e-12f * random_point(r); }), 1e-13f});
  sets.push_back({"two far clusters",
                  generate(2000, [](HashRng& r) { return random_point(r) + Point(r.next() < 0.5f ? 0.0f : 1e6f); }),
                  0.2f});
  return sets;
}

/// Points of the set, points near them, and points away from it.
std::vector<Point> queries_for(const PointSet& set) {
  HashRng rng(11);
  std::vector<Point> queries{{0, 0, 0}, {-1, 0.5f, 3}, {1e5f, -1e5f, 0}};
  for (int i = 0; i < 60 && !set.points.empty(); ++i) {
    const Point& p = set.points[static_cast<std::size_t>(rng.next() * static_cast<float>(set.points.size()))];
    queries.push_back(p);
    queries.push_back(p + 2 * set.scale * (random_point(rng) - Point(0.5f)));
    queries.push_back(p + Point(set.scale, 0, 0));
    queries.push_back(p - Point(0, set.scale, 0));
  }
  return queries;
}

double exact_dist2(const Point& a, const Point& b) {
  const double x = double{a.x} - b.x, y = double{a.y} - b.y, z = double{a.z} - b.z;
  return x * x + y * y + z * z;
}

/// Squared distances are rounded in a way that depends on the compilation: points this near to the boundary may be
/// found or not.
constexpr double rounding = 1e-6;

template <class Index>
void expect_ball(const Index& index, const std::vector<std::uint32_t>& order, const PointSet& set, const Point& q,
                 float radius) {
  const double radius2 = double{radius} * radius;
  std::vector<int> visits(set.points.size());
  index.for_each_near(q, radius, [&](std::uint32_t slot, float dist2) {
    ASSERT_LT(slot, set.points.size());
    const std::uint32_t record = order[slot];
    ++visits[record];
    const double exact = exact_dist2(set.points[record], q);
    EXPECT_NEAR(dist2, exact, rounding * exact + 1e-37);
    EXPECT_LE(dist2, radius * radius);
  });
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const double exact = exact_dist2(set.points[i], q);
    ASSERT_LE(visits[i], 1) << set.name << " point " << i << " radius " << radius;
    const bool inside = exact <= radius2 * (1 - rounding), outside = exact > radius2 * (1 + rounding) + 1e-37;
    ASSERT_TRUE(inside ? visits[i] == 1 : !outside || visits[i] == 0)
        << set.name << " point " << i << " radius " << radius;
  }
}

void expect_permutation(const std::vector<std::uint32_t>& order, std::size_t count) {
  std::vector<std::uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  ASSERT_EQ(sorted.size(), count);
  for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(sorted[i], i);
}

TEST(HashGrid, FindsWhatBruteForceFinds) {
  for (const PointSet& set : point_sets())
    for (const float fraction : {0.0f, 0.02f, 0.3f, 1.0f}) {
      const float radius = fraction * set.scale;
      const auto [grid, order] = HashGrid::build(set.points, radius);
      expect_permutation(order, set.points.size());
      for (std::uint32_t slot = 0; slot < grid.size(); ++slot) ASSERT_EQ(grid.position(slot), set.points[order[slot]]);
      for (const Point& q : queries_for(set))
        for (const float smaller : {1.0f, 0.5f, 0.0f}) expect_ball(grid, order, set, q, smaller * radius);
    }
}

/// Everything here is exact in single precision: points on the boundary of a ball must be found, even if it is also a
/// cell's boundary.
TEST(HashGrid, KeepsPointsOnTheBoundary) {
  const std::vector<Point> points = lattice(16, 1);
  for (const float radius : {1.0f, 2.0f, 3.0f}) {
    const auto [grid, order] = HashGrid::build(points, radius);
    for (const Point& q : lattice(8, 2)) {
      std::size_t found = 0, expected = 0;
      grid.for_each_near(q, radius, [&](std::uint32_t, float) { ++found; });
      for (const Point& p : points) expected += distance_squared(p, q) <= radius * radius;
      ASSERT_EQ(found, expected);
    }
  }
}

TEST(HashGrid, DoesNotDependOnThreads) {
  HashRng rng(3);
  std::vector<Point> points(100000);
  for (Point& p : points) p = random_point(rng) * Point(1, 1, 0.01f);
  std::vector<std::uint32_t> reference;
  for (const unsigned threads : {1u, 2u, 3u}) {
    const ThreadLimit limit(threads);
    const auto [grid, order] = HashGrid::build(points, 0.004f);
    if (threads == 1) reference = order;
    EXPECT_EQ(order, reference);
  }
}

template <class Tree>
class KdTree : public testing::Test {};
using KdTrees = testing::Types<LeftBalancedKdTree, BucketKdTree>;
TYPED_TEST_SUITE(KdTree, KdTrees);

constexpr std::array split_rules{SplitRule::largest_extent, SplitRule::largest_variance};

TYPED_TEST(KdTree, FindsInABallWhatBruteForceFinds) {
  for (const PointSet& set : point_sets())
    for (const SplitRule rule : split_rules) {
      const auto [tree, order] = TypeParam::build(set.points, rule);
      expect_permutation(order, set.points.size());
      for (std::uint32_t slot = 0; slot < tree.size(); ++slot) ASSERT_EQ(tree.position(slot), set.points[order[slot]]);
      for (const Point& q : queries_for(set))
        for (const float fraction : {1.0f, 0.1f, 0.0f}) expect_ball(tree, order, set, q, fraction * set.scale);
    }
}

/// The k-th smallest distances agree; each found point occurs once, at the distance reported.
template <class Tree>
void expect_nearest(const Tree& tree, const std::vector<std::uint32_t>& order, const PointSet& set, const Point& q,
                    std::size_t k, float max_radius) {
  std::vector<double> expected;
  for (const Point& p : set.points)
    if (exact_dist2(p, q) <= double{max_radius} * max_radius) expected.push_back(exact_dist2(p, q));
  std::sort(expected.begin(), expected.end());
  expected.resize(std::min(expected.size(), k));

  std::vector<Neighbour> memory(k);
  const std::span<const Neighbour> heap = tree.nearest(q, max_radius, memory);
  ASSERT_TRUE(std::is_heap(heap.begin(), heap.end()));
  std::vector<Neighbour> found(heap.begin(), heap.end());
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found.size(), expected.size()) << set.name;
  std::set<std::uint32_t> slots;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_TRUE(slots.insert(found[i].slot).second);
    ASSERT_NEAR(found[i].dist2, expected[i], rounding * expected[i] + 1e-37) << set.name << " k " << k;
    const double own = exact_dist2(set.points[order[found[i].slot]], q);
    ASSERT_NEAR(found[i].dist2, own, rounding * own + 1e-37) << set.name;
  }
}

TYPED_TEST(KdTree, FindsTheNearestThatBruteForceFinds) {
  for (const PointSet& set : point_sets())
    for (const SplitRule rule : split_rules) {
      const auto [tree, order] = TypeParam::build(set.points, rule);
      const std::vector<Point> queries = queries_for(set);
      for (std::size_t i = 0; i < queries.size(); i += 3) {
        for (const std::size_t k : {0u, 1u, 7u, 50u}) expect_nearest(tree, order, set, queries[i], k, infinity);
        // All distances are shifted by half a unit in the last place, so that none lies on the boundary.
        expect_nearest(tree, order, set, queries[i], 20, 0.3f * set.scale * 1.0001f);
      }
      expect_nearest(tree, order, set, queries[0], 4000, infinity);
    }
}

TYPED_TEST(KdTree, KeepsPointsOnTheBoundary) {
  const std::vector<Point> points = lattice(16, 1);
  const auto [tree, order] = TypeParam::build(points);
  for (const float radius : {1.0f, 2.0f, 3.0f})
    for (const Point& q : lattice(8, 2)) {
      std::size_t found = 0;
      tree.for_each_near(q, radius, [&](std::uint32_t, float) { ++found; });
      const auto expected = std::count_if(points.begin(), points.end(),
                                          [&](const Point& p) { return distance_squared(p, q) <= radius * radius; });
      ASSERT_EQ(found, static_cast<std::size_t>(expected));
      std::vector<Neighbour> memory(points.size());
      ASSERT_EQ(tree.nearest(q, radius, memory).size(), found);
    }
}

TYPED_TEST(KdTree, DoesNotDependOnThreads) {
  HashRng rng(3);
  std::vector<Point> points(100000);
  for (Point& p : points) p = random_point(rng) * Point(1, 1, 0.01f);
  std::vector<std::uint32_t> reference;
  for (const unsigned threads : {1u, 2u, 3u}) {
    const ThreadLimit limit(threads);
    const auto [tree, order] = TypeParam::build(points);
    if (threads == 1) reference = order;
    EXPECT_EQ(order, reference);
  }
}

TEST(LeftBalancedKdTree, EveryNodeSplitsItsSubtree) {
  HashRng rng(5);
  for (const std::size_t count : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 100u, 1000u}) {
    std::vector<Point> points(count);
    for (Point& p : points) p = {rng.next(), 0, 0};  // one axis: the tree is a search tree
    const auto [tree, order] = LeftBalancedKdTree::build(points);
    for (std::uint32_t slot = 1; slot < count; ++slot) {
      // An ancestor must lie on the side that the path from it to this node implies.
      for (std::uint32_t below = slot; below > 0; below = (below - 1) / 2) {
        const float parent = tree.position((below - 1) / 2).x;
        if (below % 2 == 1) {
          ASSERT_LE(tree.position(slot).x, parent);
        } else {
          ASSERT_GE(tree.position(slot).x, parent);
        }
      }
    }
  }
}

}  // namespace
}  // namespace lanthorn::point_index_test
