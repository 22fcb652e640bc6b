// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The point indices against nanoflann: building, the 50 nearest points, and all points in a ball, for points in a cube
// and on surfaces. Arguments: number of points, 0 = cube or 1 = surfaces, and for builds the number of threads. Queries
// are random points of the set, slightly displaced, in random order, on one thread.
#include <benchmark/benchmark.h>

#include <nanoflann.hpp>

#include "base/parallel.h"
#include "cache_points.h"
#include "index/bucket_kdtree.h"
#include "index/hash_grid.h"
#include "index/left_balanced_kdtree.h"

namespace lanthorn::bench {
namespace {

constexpr std::size_t k = 50;
constexpr std::size_t query_count = 20000;

struct Cloud {
  const std::vector<Point>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<int>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Nanoflann =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3, std::uint32_t>;

const std::vector<Point>& points_for(const benchmark::State& state) {
  static std::vector<Point> points;
  static std::pair<std::int64_t, std::int64_t> made{-1, -1};
  const std::pair wanted{state.range(0), state.range(1)};
  if (made != wanted) {
    const auto count = static_cast<std::size_t>(wanted.first);
    points = wanted.second != 0 ? surface_points(count, 1) : uniform_points(count, 1);
    made = wanted;
  }
  return points;
}

std::vector<Point> queries_for(const std::vector<Point>& points) {
  HashRng rng(2);
  std::vector<Point> queries(query_count);
  for (Point& q : queries)
    q = points[static_cast<std::size_t>(rng.next() * static_cast<float>(points.size()))] +
        1e-3f * (Point(rng.next(), rng.next(), rng.next()) - Point(0.5f));
  return queries;
}

/// A radius that finds about 30 points on average.
float radius_for(const benchmark::State& state) {
  const auto count = static_cast<float>(state.range(0));
  return state.range(1) != 0 ? std::sqrt(30 * 49.0f / 2.1f / (pi * count)) : std::cbrt(30 / (4.0f / 3 * pi * count));
}

void finish(benchmark::State& state, std::size_t found) {
  const double queries = static_cast<double>(state.iterations()) * query_count;
  state.counters["found"] = static_cast<double>(found) / queries;
  state.counters["ns/query"] =
      benchmark::Counter(queries * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class Index>
void nearest(benchmark::State& state) {
  const auto& points = points_for(state);
  const auto queries = queries_for(points);
  const auto [index, order] = Index::build(points);
  std::vector<Neighbour> heap(k);
  std::size_t found = 0;
  for (auto _ : state)
    for (const Point& q : queries) found += index.nearest(q, infinity, heap).size();
  finish(state, found);
}

template <class Index, class... Arguments>
void ball(benchmark::State& state, const Index& index) {
  const auto queries = queries_for(points_for(state));
  const float radius = radius_for(state);
  std::size_t found = 0;
  float sum = 0;
  for (auto _ : state) {
    for (const Point& q : queries)
      index.for_each_near(q, radius, [&](std::uint32_t slot, float dist2) {
        ++found;
        sum += dist2 + static_cast<float>(slot);
      });
    benchmark::DoNotOptimize(sum);
  }
  finish(state, found);
}
template <class Tree>
void ball_in_tree(benchmark::State& state) {
  ball(state, Tree::build(points_for(state)).index);
}
void ball_in_grid(benchmark::State& state) { ball(state, HashGrid::build(points_for(state), radius_for(state)).index); }

template <class Tree>
void build_tree(benchmark::State& state) {
  const ThreadLimit limit(static_cast<unsigned>(state.range(2)));
  const auto& points = points_for(state);
  for (auto _ : state) benchmark::DoNotOptimize(Tree::build(points));
}
void build_grid(benchmark::State& state) {
  const ThreadLimit limit(static_cast<unsigned>(state.range(2)));
  const auto& points = points_for(state);
  for (auto _ : state) benchmark::DoNotOptimize(HashGrid::build(points, radius_for(state)));
}

template <std::size_t leaf_size>
void build_nanoflann(benchmark::State& state) {
  const Cloud cloud{points_for(state)};
  for (auto _ : state) {
    Nanoflann tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size));
    tree.buildIndex();
    benchmark::DoNotOptimize(&tree);
  }
}
template <std::size_t leaf_size>
void nearest_nanoflann(benchmark::State& state) {
  const Cloud cloud{points_for(state)};
  const auto queries = queries_for(cloud.points);
  Nanoflann tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size));
  tree.buildIndex();
  std::vector<std::uint32_t> indices(k);
  std::vector<float> dist2(k);
  std::size_t found = 0;
  for (auto _ : state)
    for (const Point& q : queries) found += tree.knnSearch(&q.x, k, indices.data(), dist2.data());
  finish(state, found);
}
template <std::size_t leaf_size>
void ball_nanoflann(benchmark::State& state) {
  const Cloud cloud{points_for(state)};
  const auto queries = queries_for(cloud.points);
  Nanoflann tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size));
  tree.buildIndex();
  const float radius = radius_for(state);
  std::vector<std::pair<std::uint32_t, float>> matches;
  std::size_t found = 0;
  for (auto _ : state)
    for (const Point& q : queries)
      found += tree.radiusSearch(&q.x, radius * radius, matches, nanoflann::SearchParams(32, 0, false));
  finish(state, found);
}

const std::vector<std::int64_t> sizes{100000, 1000000, 10000000};

void sets(benchmark::internal::Benchmark* b) { b->ArgsProduct({sizes, {0, 1}})->Unit(benchmark::kMillisecond); }
void threads(benchmark::internal::Benchmark* b) {
  b->ArgsProduct({sizes, {0, 1}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(build_tree<LeftBalancedKdTree>)->Apply(threads);
BENCHMARK(build_tree<BucketKdTree>)->Apply(threads);
BENCHMARK(build_grid)->Apply(threads);
BENCHMARK(build_nanoflann<10>)->Apply(sets);
BENCHMARK(build_nanoflann<32>)->Apply(sets);
BENCHMARK(nearest<LeftBalancedKdTree>)->Apply(sets);
BENCHMARK(nearest<BucketKdTree>)->Apply(sets);
BENCHMARK(nearest_nanoflann<10>)->Apply(sets);
BENCHMARK(nearest_nanoflann<32>)->Apply(sets);
BENCHMARK(ball_in_tree<LeftBalancedKdTree>)->Apply(sets);
BENCHMARK(ball_in_tree<BucketKdTree>)->Apply(sets);
BENCHMARK(ball_in_grid)->Apply(sets);
BENCHMARK(ball_nanoflann<10>)->Apply(sets);
BENCHMARK(ball_nanoflann<32>)->Apply(sets);

}  // namespace
}  // namespace lanthorn::bench

BENCHMARK_MAIN();
