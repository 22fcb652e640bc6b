// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The queries of one pass of progressive photon mapping to the hash grid: 500 k photons on surfaces, one query for each
// of the 512² eye points of an image in scan order, 1 - 10 photons in the ball.
#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "cache_points.h"
#include "index/hash_grid.h"

namespace lanthorn::bench {
namespace {

constexpr std::size_t photons = 500000;
constexpr float room_area = 24 + 2 * 8 * 4 * pi * 0.35f * 0.35f;  // weighted as the photons are

float radius_for(double photons_in_ball) {
  return static_cast<float>(std::sqrt(photons_in_ball * room_area / (pi * static_cast<double>(photons))));
}

/// Arguments: photons in the ball, surfaces aligned with the axes.
void query(benchmark::State& state) {
  const bool aligned = state.range(1) != 0;
  const float radius = radius_for(static_cast<double>(state.range(0)));
  const auto points = surface_points(photons, 1, aligned);
  const auto queries = eye_points(512, 2, aligned);
  const auto [grid, order] = HashGrid::build(points, radius);
  std::size_t found = 0;
  float sum = 0;
  for (auto _ : state) {
    found = 0;
    for (const Point& q : queries)
      grid.for_each_near(q, radius, [&](std::uint32_t, float dist2) { ++found, sum += dist2; });
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(queries.size()));
  state.counters["found"] = static_cast<double>(found) / static_cast<double>(queries.size());
  state.counters["table_bytes/photon"] = static_cast<double>(grid.table_bytes()) / static_cast<double>(photons);
  state.counters["ns/query"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(queries.size()) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(query)->ArgsProduct({{1, 3, 10}, {0, 1}})->Unit(benchmark::kMillisecond);

/// Arguments: photons in the ball, threads.
void build(benchmark::State& state) {
  const ThreadLimit limit(static_cast<unsigned>(state.range(1)));
  const float radius = radius_for(static_cast<double>(state.range(0)));
  const auto points = surface_points(photons, 1);
  for (auto _ : state) benchmark::DoNotOptimize(HashGrid::build(points, radius));
}
BENCHMARK(build)
    ->ArgsProduct({{1, 3, 10}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace lanthorn::bench

BENCHMARK_MAIN();
