// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The indices of balls and beams against brute force: building, and queries by position and by ray. Arguments: number
// of items; kind of set. All items have the same radius, chosen so that a query finds about ten of them. Beams and
// balls lie in the unit cube, which rays cross from the middle of one face. Queries use one thread; for builds, the
// last argument is the number of threads.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>

#include "base/parallel.h"
#include "index/ball_bvh.h"
#include "index/beam_bvh.h"
#include "math/hash.h"
#include "math/sampling.h"

namespace lanthorn::bench {
namespace {

constexpr std::size_t query_count = 2000;
constexpr double wanted_hits = 10;

Point random_point(HashRng& rng) { return {rng.next(), rng.next(), rng.next()}; }

/// Where a line from inside the unit cube leaves it.
float way_out(const Point& p, const Direction& d) {
  float t = infinity;
  for (int axis = 0; axis < 3; ++axis)
    if (d[axis] != 0) t = std::min(t, ((d[axis] > 0 ? 1 : 0) - p[axis]) / d[axis]);
  return std::max(t, 0.0f);
}

std::vector<RaySegment> rays() {
  HashRng rng(2);
  std::vector<RaySegment> result(query_count);
  for (RaySegment& ray : result) {
    ray.origin = {0.5f, 0.5f, 0};
    ray.direction = normalize(Point(rng.next(), rng.next(), 1) - ray.origin);
    ray.end = way_out(ray.origin, ray.direction);
  }
  return result;
}
std::vector<Point> positions() {
  HashRng rng(3);
  std::vector<Point> result(query_count);
  for (Point& p : result) p = random_point(rng);
  return result;
}

/// 0: from one point of the ceiling to the floor and the walls. 1: like multiply scattered light: from all points in
/// all directions, with a mean length of a quarter of the cube. 2: half of each, with a tenth of the first half focused
/// by a lens to a point in the middle.
std::vector<Beam> beams(std::size_t count, std::int64_t kind) {
  HashRng rng(1);
  std::vector<Beam> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    Beam& beam = result[i];
    if (kind == 0 || (kind == 2 && i % 2 == 0)) {
      beam.origin = {0.5f, 0.999f, 0.5f};
      beam.direction = sample_uniform_sphere(rng.next2());
      beam.direction.y = -std::fabs(beam.direction.y);
      if (kind == 2 && i % 20 == 0) {
        beam.origin = {0.3f + 0.1f * rng.next(), 0.9f, 0.3f + 0.1f * rng.next()};
        beam.direction = normalize(Point(0.5f, 0.5f, 0.5f) - beam.origin);
      }
      beam.length = way_out(beam.origin, beam.direction);
    } else {
      beam.origin = random_point(rng);
      beam.direction = sample_uniform_sphere(rng.next2());
      beam.length = std::min(-0.25f * std::log(1 - rng.next()), way_out(beam.origin, beam.direction));
    }
  }
  return result;
}
/// 0: uniform. 1: along beams of kind 2.
std::vector<Ball> balls(std::size_t count, std::int64_t kind) {
  HashRng rng(4);
  std::vector<Ball> result(count);
  for (Ball& ball : result) ball.centre = random_point(rng);
  if (kind == 0) return result;
  const std::vector<Beam> on = beams(count, 2);
  for (std::size_t i = 0; i < count; ++i) result[i].centre = on[i].origin + rng.next() * on[i].length * on[i].direction;
  return result;
}

// Results, so that queries are not optimised away.
struct Found {
  std::size_t count = 0;
  float sum = 0;

  void operator()(std::uint32_t slot, float dist2) { ++count, sum += dist2 + static_cast<float>(slot); }
  void operator()(std::uint32_t slot, float t, float dist2) { ++count, sum += t + dist2 + static_cast<float>(slot); }
  void operator()(std::uint32_t slot, const BeamCrossing& c) { ++count, sum += c.t + c.sin + static_cast<float>(slot); }
};

struct RayAtBalls {
  using Index = BallBvh;
  static constexpr double power = 2;  // hits are proportional to the radius to this power
  static auto items(const benchmark::State& s) { return balls(static_cast<std::size_t>(s.range(0)), s.range(1)); }
  static auto queries() { return rays(); }
  static void ask(const BallBvh& index, const RaySegment& ray, Found& found) { index.for_each_along(ray, found); }
  static void force(const Ball& ball, const RaySegment& ray, Found& found) {
    const FootPoint foot = foot_on_line(ball.centre, ray.origin, ray.direction);
    if (foot.t >= ray.begin && foot.t <= ray.end && foot.dist2 <= sqr(ball.radius)) found(0, 0.0f);
  }
};
struct PositionInBalls : RayAtBalls {
  static constexpr double power = 3;
  static auto queries() { return positions(); }
  static void ask(const BallBvh& index, const Point& p, Found& found) { index.for_each_containing(p, found); }
  static void force(const Ball& ball, const Point& p, Found& found) {
    if (distance_squared(ball.centre, p) <= sqr(ball.radius)) found(0, 0.0f);
  }
};
struct RayAtBeams {
  using Index = BeamBvh;
  static constexpr double power = 1;
  static auto items(const benchmark::State& s) { return beams(static_cast<std::size_t>(s.range(0)), s.range(1)); }
  static auto queries() { return rays(); }
  static void ask(const BeamBvh& index, const RaySegment& ray, Found& found) { index.for_each_crossing(ray, found); }
  static void force(const Beam& beam, const RaySegment& ray, Found& found) {
    if (const auto crossing = crossing_of(ray, beam)) found(0, static_cast<float>(crossing->t));
  }
};
struct PositionInBeams : RayAtBeams {
  static constexpr double power = 2;
  static auto queries() { return positions(); }
  static void ask(const BeamBvh& index, const Point& p, Found& found) { index.for_each_around(p, found); }
  static void force(const Beam& beam, const Point& p, Found& found) {
    const FootPoint foot = foot_on_line(p, beam.origin, beam.direction);
    if (foot.t >= 0 && foot.t <= beam.length && foot.dist2 <= sqr(beam.radius)) found(0, 0.0f);
  }
};

/// Items whose radius makes a query find `wanted_hits` of them on average.
template <class Case>
auto items_for(const benchmark::State& state) {
  auto items = Case::items(state);
  const auto queries = Case::queries();
  double radius = 0.02;
  for (int round = 0; round < 3; ++round) {
    for (auto& item : items) item.radius = static_cast<float>(radius);
    const auto [index, order] = Case::Index::build(items);
    Found found;
    for (std::size_t q = 0; q < query_count; q += 10) Case::ask(index, queries[q], found);
    const double hits = static_cast<double>(found.count) / (query_count / 10);
    radius *= std::pow(wanted_hits / std::max(hits, 0.1), 1 / Case::power);
  }
  for (auto& item : items) item.radius = static_cast<float>(radius);
  return items;
}

template <class Case>
void query(benchmark::State& state) {
  const auto queries = Case::queries();
  const auto [index, order] = Case::Index::build(items_for<Case>(state));
  Found found;
  for (auto _ : state)
    for (const auto& q : queries) Case::ask(index, q, found);
  benchmark::DoNotOptimize(found.sum);
  const double asked = static_cast<double>(state.iterations()) * query_count;
  state.counters["found"] = static_cast<double>(found.count) / asked;
  state.counters["us/query"] =
      benchmark::Counter(asked * 1e-6, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class Case>
void brute_force(benchmark::State& state) {
  const auto queries = Case::queries();
  const auto items = items_for<Case>(state);
  Found found;
  std::size_t asked = 0;
  for (auto _ : state) {
    const auto& q = queries[asked++ % query_count];
    for (const auto& item : items) Case::force(item, q, found);
    benchmark::DoNotOptimize(found);
  }
  state.counters["us/query"] =
      benchmark::Counter(static_cast<double>(asked) * 1e-6, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <class Case>
void build(benchmark::State& state) {
  const ThreadLimit limit(static_cast<unsigned>(state.range(2)));
  const auto items = Case::items(state);
  for (auto _ : state) benchmark::DoNotOptimize(Case::Index::build(items));
  state.counters["items/s"] =
      benchmark::Counter(static_cast<double>(items.size()), benchmark::Counter::kIsIterationInvariantRate);
}

const std::vector<std::int64_t> sizes{100000, 1000000};

BENCHMARK(build<RayAtBalls>)
    ->ArgsProduct({sizes, {0, 1}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK(build<RayAtBeams>)
    ->ArgsProduct({sizes, {0, 1, 2}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK(query<PositionInBalls>)->ArgsProduct({sizes, {0, 1}})->Unit(benchmark::kMillisecond);
BENCHMARK(query<RayAtBalls>)->ArgsProduct({sizes, {0, 1}})->Unit(benchmark::kMillisecond);
BENCHMARK(query<PositionInBeams>)->ArgsProduct({sizes, {0, 1, 2}})->Unit(benchmark::kMillisecond);
BENCHMARK(query<RayAtBeams>)->ArgsProduct({sizes, {0, 1, 2}})->Unit(benchmark::kMillisecond);
BENCHMARK(brute_force<PositionInBalls>)->ArgsProduct({{100000}, {0}})->Unit(benchmark::kMillisecond);
BENCHMARK(brute_force<RayAtBalls>)->ArgsProduct({{100000}, {0}})->Unit(benchmark::kMillisecond);
BENCHMARK(brute_force<PositionInBeams>)->ArgsProduct({{100000}, {0}})->Unit(benchmark::kMillisecond);
BENCHMARK(brute_force<RayAtBeams>)->ArgsProduct({{100000}, {0}})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lanthorn::bench

BENCHMARK_MAIN();
