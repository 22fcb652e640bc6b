// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "ibl/spherical_harmonics.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "base/parallel.h"

namespace lanthorn {

namespace {

constexpr std::size_t bands = 4;

// Coefficients of the clamped cosine, divided by pi [R01 eqs. 8 and 9].
constexpr std::array<double, bands> cosine_lobe{1, 2.0 / 3, 1.0 / 4, 0};

std::size_t band_of(std::size_t i) { return i < 1 ? 0 : i < 4 ? 1 : i < 9 ? 2 : 3; }

ShCoefficients<bands> irradiance_of(const ShCoefficients<bands>& radiance, double lambda) {
  ShCoefficients<bands> result;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto l = static_cast<double>(band_of(i));
    const double window = 1 / (1 + lambda * sqr(l * (l + 1)));  // [S08, "Windowing"]
    result[i] = static_cast<float>(cosine_lobe[band_of(i)] * window) * radiance[i];
  }
  return result;
}

float least_irradiance(const ShMaps& sh) {
  constexpr int across = 16;
  const CubeMap directions(across);
  float least = infinity;
  for (int face = 0; face < cube_faces; ++face)
    for (int y = 0; y < across; ++y)
      for (int x = 0; x < across; ++x) {
        const Direction d = directions.direction(face, x, y);
        const Rgb e = irradiance_at(sh, {d.x, d.y, d.z}, 3);
        least = std::min({least, e.r, e.g, e.b});
      }
  return least;
}

// A window this strong leaves only the mean.
constexpr double strongest_window = 1e3;

// Bisection: the minimum of the irradiance increases with the window.
void window_irradiance(ShMaps& sh) {
  const auto is_positive = [&](double lambda) {
    sh.irradiance = irradiance_of(sh.radiance, lambda);
    return least_irradiance(sh) >= 0;
  };
  if (is_positive(0)) return;
  double low = 0, high = strongest_window;
  constexpr int steps = 40;
  for (int i = 0; i < steps; ++i) {
    const double middle = low > 0 ? 0.5 * (low + high) : 0.1 * high;
    if (is_positive(middle))
      high = middle;
    else
      low = middle;
  }
  sh.window = high;
  sh.irradiance = irradiance_of(sh.radiance, high);
}

struct ProjectionSums {
  std::array<std::array<double, bands * bands>, 3> by_channel{};
  double solid_angle = 0;

  void add(const ProjectionSums& other) {
    for (std::size_t c = 0; c < by_channel.size(); ++c)
      for (std::size_t i = 0; i < bands * bands; ++i) by_channel[c][i] += other.by_channel[c][i];
    solid_angle += other.solid_angle;
  }
};

ProjectionSums sum_of_row(const Environment& environment, int y) {
  // Floats allow wider vector instructions than doubles, but only short sums: rounding errors of equal terms add up.
  constexpr int at_a_time = 64;
  alignas(64) std::array<std::array<float, bands * bands>, 3> sums{};
  int terms = 0;
  ProjectionSums result;
  const auto flush = [&] {
    for (std::size_t c = 0; c < sums.size(); ++c)
      for (std::size_t i = 0; i < bands * bands; ++i) result.by_channel[c][i] += static_cast<double>(sums[c][i]);
    sums = {};
    terms = 0;
  };
  environment.for_points_of_row(y, environment.pieces_for_smooth_kernels(), [&](const PointFlux& point) {
    const std::array<float, bands* bands> basis = sh_basis(point.direction);
    for (std::size_t c = 0; c < sums.size(); ++c)
      for (std::size_t i = 0; i < basis.size(); ++i) sums[c][i] += point.flux.v[c] * basis[i];
    result.solid_angle += static_cast<double>(point.flux[3]);
    if (++terms == at_a_time) flush();
  });
  flush();
  return result;
}

ProjectionSums sum_of_texels(const Environment& environment) {
  std::vector<ProjectionSums> rows(static_cast<std::size_t>(environment.height()));
  parallel_for(0, environment.height(), [&](int y) { rows[static_cast<std::size_t>(y)] = sum_of_row(environment, y); });
  ProjectionSums sums;
  for (const ProjectionSums& row : rows) sums.add(row);
  return sums;
}

}  // namespace

std::array<float, 16> sh_basis(const Vec3& d) {
  const float x = d.x, y = d.y, z = d.z;
  return {0.28209479f,
          0.48860251f * y,
          0.48860251f * z,
          0.48860251f * x,
          1.09254843f * x * y,
          1.09254843f * y * z,
          0.31539157f * (3 * z * z - 1),
          1.09254843f * x * z,
          0.54627422f * (x * x - y * y),
          0.59004359f * y * (3 * x * x - y * y),
          2.89061144f * x * y * z,
          0.45704580f * y * (5 * z * z - 1),
          0.37317633f * z * (5 * z * z - 3),
          0.45704580f * x * (5 * z * z - 1),
          1.44530572f * z * (x * x - y * y),
          0.59004359f * x * (x * x - 3 * y * y)};
}

Rgb irradiance_at(const ShMaps& sh, const std::array<float, 3>& normal, std::size_t order) {
  const std::array<float, 16> basis = sh_basis({normal[0], normal[1], normal[2]});
  Rgb sum;
  for (std::size_t i = 0; i < sqr(order + 1); ++i) sum += basis[i] * sh.irradiance[i];
  return sum;
}

ShMaps project_to_sh(const Environment& environment, bool windowed) {
  const ProjectionSums sums = sum_of_texels(environment);
  ShMaps sh;
  for (std::size_t i = 0; i < sh.radiance.size(); ++i) {
    const auto coefficient = [&](std::size_t c) {
      return static_cast<float>(sums.by_channel[c][i] * 4 * std::numbers::pi / sums.solid_angle);
    };
    sh.radiance[i] = {coefficient(0), coefficient(1), coefficient(2)};
  }
  sh.irradiance = irradiance_of(sh.radiance, 0);
  if (windowed) window_irradiance(sh);
  return sh;
}

}  // namespace lanthorn
