// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/path_weights.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

namespace {

// What is left, at each vertex, of the gain of merging.
void correlation_factors(std::span<const PathVertex> path, float first_distance, float light_paths,
                         std::vector<double>& c) {
  constexpr float tan_of_one_degree = 0.017455f;
  const float area = pi * sqr(tan_of_one_degree * first_distance);
  const auto probability = [&](float density) { return static_cast<double>(std::fmin(1.0f, density * area)); };
  const double least = 1 / static_cast<double>(light_paths);
  c.resize(path.size());
  double by_light = 1;
  for (std::size_t i = path.size(); i-- > 0;) c[i] = by_light *= probability(path[i].by_light);
  double by_eye = probability(path[0].by_eye);
  c[0] = 1;  // what the eye sees directly is merged with different photons in each pixel
  for (std::size_t i = 1; i < path.size(); ++i) {
    by_eye *= probability(path[i].by_eye);
    const double either = by_eye + c[i] - by_eye * c[i];
    c[i] = either > 0 ? std::max(by_eye / either, least) : 1.0;
  }
}

// 0 where rounding has left a walk without density: along a surface.
double ratio(float a, float b) { return b > 0 ? static_cast<double>(a / b) : 0.0; }

}  // namespace

// With E_j the product of the eye walk's densities up to x_j and the light walk's from x_{j+1} to x_k, over that of the
// technique asked for: connections j < k have density E_j by_light(z), next-event estimation E_k direct, hits
// E_k by_eye(z), merges at x_j E_j by_light(x_j) by_light(z) η c_j, the lens N times a connection's.
float path_weight(std::span<const PathVertex> path, float direct, const Making& making, const Techniques& t,
                  float first_distance) {
  thread_local std::vector<double> c;
  if (t.correlated) correlation_factors(path, first_distance, t.light_paths, c);
  const std::size_t k = path.size() - 1;
  const PathVertex& z = path[k];
  const bool connects = t.merging == 0 || t.connecting > 0;
  const bool all_delta = std::all_of(path.begin(), path.end() - 1, [](const PathVertex& v) { return v.delta; });
  const auto is_open = [&](std::size_t j) { return j == 0 || !path[j - 1].delta; };  // from x_j one may connect
  const auto connection = [&](std::size_t j) -> double {
    if (!connects || !is_open(j) || (j < k && path[j].delta)) return 0;
    const double samples = j == 0 ? static_cast<double>(t.light_paths) : 1;
    return samples * static_cast<double>(j == k ? direct : z.by_light);
  };
  const auto merge = [&](std::size_t j) -> double {  // j from 1
    const PathVertex& x = path[j - 1];
    if (!x.merges || x.delta) return 0;
    return static_cast<double>(x.by_light) * static_cast<double>(z.by_light) * static_cast<double>(t.merging) *
           (t.correlated ? c[j - 1] : 1.0);
  };
  const double hit = connects || all_delta ? static_cast<double>(z.by_eye) : 0.0;
  const auto ways_at = [&](std::size_t j) {
    return connection(j) + (j > 0 ? merge(j) : 0.0) + (j == k ? hit : 0.0);
  };

  const std::size_t own = std::min(making.eye_vertices, k);
  double sum = ways_at(own);
  double e = 1;
  for (std::size_t j = own; j > 0; --j) {
    e *= ratio(path[j - 1].by_light, path[j - 1].by_eye);
    sum += e * ways_at(j - 1);
  }
  e = 1;
  for (std::size_t j = own + 1; j <= k; ++j) {
    e *= ratio(path[j - 1].by_eye, path[j - 1].by_light);
    sum += e * ways_at(j);
  }
  const double density = making.merged ? merge(own) : (making.eye_vertices > k ? hit : connection(own));
  return density > 0 ? static_cast<float>(density / sum) : 0.0f;
}

namespace {

// The vertices of both subpaths, from the eye's on; the densities at the junction are the caller's to set.
std::vector<PathVertex>& join(std::span<const TrailVertex> eye, std::span<const TrailVertex> light) {
  thread_local std::vector<PathVertex> path;
  path.resize(eye.size() + light.size());
  auto next = std::transform(eye.begin(), eye.end(), path.begin(), [](const TrailVertex& v) {
    return PathVertex{v.arrives, v.back, v.delta, v.merges};
  });
  std::transform(light.rbegin(), light.rend(), next, [](const TrailVertex& v) {
    return PathVertex{v.back, v.arrives, v.delta, v.merges};
  });
  return path;
}

}  // namespace

float weight_of_joined(std::span<const TrailVertex> eye, const Junction& at_eye, std::span<const TrailVertex> light,
                       const Junction& at_light, const Techniques& t, float first_distance) {
  std::vector<PathVertex>& path = join(eye, light);
  const std::size_t s = eye.size();
  if (s > 0) {
    path[s - 1].by_light = at_eye.arrives;
    path[s - 1].delta = false;
  }
  if (s > 1 && at_eye.reverse) path[s - 2].by_light = *at_eye.reverse * eye[s - 2].geometry;
  path[s].by_eye = at_light.arrives;
  path[s].delta = false;
  if (light.size() > 1) path[s + 1].by_eye = at_light.reverse.value_or(0) * light[light.size() - 2].geometry;
  return path_weight(path, light.front().direct, {false, s}, t, first_distance);
}

float weight_of_hit(std::span<const TrailVertex> eye, float arrives, const TrailVertex& z, const Techniques& t,
                    float first_distance) {
  std::vector<PathVertex>& path = join(eye, {&z, 1});
  path[eye.size() - 1].by_light = arrives;
  return path_weight(path, z.direct, {false, eye.size() + 1}, t, first_distance);
}

float weight_of_merged(std::span<const TrailVertex> eye, std::span<const TrailVertex> light, float forward,
                       float reverse, const Techniques& t, float first_distance) {
  std::vector<PathVertex>& path = join(eye, light.first(light.size() - 1));
  const std::size_t s = eye.size();
  path[s - 1].by_light = light.back().arrives;
  path[s - 1].delta = false;
  if (s > 1) path[s - 2].by_light = reverse * eye[s - 2].geometry;
  path[s].by_eye = forward * light[light.size() - 2].geometry;
  return path_weight(path, light.front().direct, {true, s}, t, first_distance);
}

}  // namespace lanthorn
