// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/path_weights.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

namespace {

// The factor c of merging at each vertex, by probabilities (Grittmann et al. 2021; see path_weight).
void factors_by_chances(std::span<const PathVertex> path, float first_distance, float light_paths,
                        std::vector<double>& c) {
  constexpr float tan_of_one_degree = 0.017455f;
  const float area = pi * sqr(tan_of_one_degree * first_distance);
  const auto probability = [&](float density) { return static_cast<double>(std::fmin(1.0f, density * area)); };
  const double least = 1 / static_cast<double>(light_paths);
  c.resize(path.size());
  double by_light = 1;
  for (std::size_t i = path.size(); i-- > 0;) c[i] = by_light *= probability(path[i].by_light);
  double by_eye = probability(path[0].by_eye);
  c[0] = 1;  // at the first vertex, each pixel merges with different photons
  for (std::size_t i = 1; i < path.size(); ++i) {
    by_eye *= probability(path[i].by_eye);
    const double either = by_eye + c[i] - by_eye * c[i];
    c[i] = either > 0 ? std::max(by_eye / either, least) : 1.0;
  }
}

// The same by footprints (Jendersie 2019): the footprint's radius is the sum of the radii that the scatterings add.
void factors_by_footprints(std::span<const PathVertex> path, float light_paths, std::vector<double>& c) {
  const auto spread = [](float density) { return density > 0 ? 1 / std::sqrt(static_cast<double>(density)) : 0.0; };
  const std::size_t count = path.size();
  c.resize(count);
  double by_light = 0;
  for (std::size_t i = count; i-- > 0;) {
    if (i + 1 == count || !path[i + 1].delta) by_light += spread(path[i].by_light);
    c[i] = by_light;
  }
  double by_eye = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0 || !path[i - 1].delta) by_eye += spread(path[i].by_eye);
    const double q = c[i] > 0 ? std::pow(by_eye / c[i], 4) : 0.0;
    c[i] = (1 + q) / (1 + static_cast<double>(light_paths) * q);
  }
}

// 0 if rounding has made a density zero, for walks along a surface.
double ratio(float a, float b) { return b > 0 ? static_cast<double>(a / b) : 0.0; }

// The densities n p c of a path's techniques. E_j is the product of the eye walk's densities up to x_j and the light
// walk's from x_{j+1} to x_k. The density of a technique whose eye walk samples x_1 ... x_j is E_j times the value of
// these functions.
class TechniqueDensities {
 public:
  TechniqueDensities(std::span<const PathVertex> path, float direct, const Techniques& t, const std::vector<double>& c)
      : path_(path), z_(path.back()), c_(c), direct_(static_cast<double>(direct)), t_(t) {}

  std::size_t k() const { return path_.size() - 1; }
  double connection(std::size_t j) const {
    if (!t_.connects || (j > 0 && path_[j - 1].delta)) return 0;
    if (j == k()) return direct_;
    if (path_[j].delta) return 0;
    return (j == 0 ? static_cast<double>(t_.light_paths) : 1) * static_cast<double>(z_.by_light);
  }
  double merge(std::size_t j) const {
    if (j == 0 || (j == k() && t_.connects)) return 0;
    const PathVertex& x = path_[j - 1];
    if (!x.merges || x.delta) return 0;
    return static_cast<double>(x.by_light) * static_cast<double>(z_.by_light) * static_cast<double>(t_.merging) *
           (t_.correlated() ? c_[j - 1] : 1.0);
  }
  // With merging alone, the walk's hits add only light that no photon can bring.
  double hit(std::size_t j) const {
    if (j < k()) return 0;
    const auto is_delta = [](const PathVertex& v) { return v.delta; };
    return t_.connects || std::all_of(path_.begin(), path_.end() - 1, is_delta) ? static_cast<double>(z_.by_eye) : 0.0;
  }
  double all(std::size_t j) const { return connection(j) + merge(j) + hit(j); }

 private:
  std::span<const PathVertex> path_;
  const PathVertex& z_;
  const std::vector<double>& c_;
  double direct_;
  const Techniques& t_;
};

}  // namespace

float path_weight(std::span<const PathVertex> path, float direct, const PathTechnique& technique, const Techniques& t,
                  float first_distance) {
  thread_local std::vector<double> c;
  if (t.correlation == Correlation::chances) factors_by_chances(path, first_distance, t.light_paths, c);
  if (t.correlation == Correlation::footprints) factors_by_footprints(path, t.light_paths, c);
  const TechniqueDensities densities(path, direct, t, c);
  const std::size_t k = densities.k(), own = std::min(technique.eye_vertices, k);
  double sum = densities.all(own);
  double e = 1;  // E_j / E_own
  for (std::size_t j = own; j > 0; --j) {
    e *= ratio(path[j - 1].by_light, path[j - 1].by_eye);
    sum += e * densities.all(j - 1);
  }
  e = 1;
  for (std::size_t j = own + 1; j <= k; ++j) {
    e *= ratio(path[j - 1].by_eye, path[j - 1].by_light);
    sum += e * densities.all(j);
  }
  double density = densities.connection(own);
  if (technique.merged) density = densities.merge(own);
  if (technique.eye_vertices > k) density = densities.hit(own);
  return density > 0 ? static_cast<float>(density / sum) : 0.0f;
}

namespace {

// The vertices of both subpaths, starting at the eye. The caller sets the densities at the junction.
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
