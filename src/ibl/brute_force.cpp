// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "ibl/brute_force.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ibl/point_sums.h"
#include "ibl/prefilter.h"

namespace lanthorn {

namespace {

Direction brightest_direction(const Environment& environment) {
  float largest = -1;
  Direction brightest{0, 1, 0};
  for (int y = 0; y < environment.height(); ++y)
    for (int x = 0; x < environment.width(); ++x) {
      const float value = max_component(environment.texel(x, y));
      if (value <= largest) continue;
      largest = value;
      brightest = environment.direction_of_texel(x, y);
    }
  return brightest;
}

template <class Kernel>
SpectrumBatch sum_rows(const Environment& environment, int begin, int end, int pieces, const Kernel& kernel,
                       const DirectionBatch& at) {
  SpectrumBatch sums;
  for (int y = begin; y < end; ++y) {
    // Sums up each row separately, so that small numbers are not lost in large ones.
    SpectrumBatch row;
    environment.for_points_of_row(y, pieces, [&](const PointFlux& point) { add_point(point, kernel, at, row); });
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t i = 0; i < batch_size; ++i) sums.v[c][i] += row.v[c][i];
  }
  return sums;
}

template <class Kernel>
std::vector<Spectrum> integrate_kernel(const Environment& environment, const std::vector<Direction>& directions,
                                       int pieces, const Kernel& kernel) {
  std::vector<Spectrum> result;
  for (std::size_t first = 0; first < directions.size(); first += batch_size) {
    DirectionBatch at;
    for (std::size_t i = 0; i < batch_size; ++i) at.set(i, directions[std::min(first + i, directions.size() - 1)]);
    constexpr std::size_t rows_each = 16;
    const auto rows = static_cast<std::size_t>(environment.height());
    std::vector<SpectrumBatch> parts((rows + rows_each - 1) / rows_each);
    parallel_chunks(rows, rows_each, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      parts[chunk] = sum_rows(environment, static_cast<int>(begin), static_cast<int>(end), pieces, kernel, at);
    });
    for (std::size_t i = 0; i < std::min(batch_size, directions.size() - first); ++i) {
      Spectrum sum;
      for (const SpectrumBatch& part : parts) sum += part[i];
      result.push_back(Spectrum{sum[0], sum[1], sum[2], 0} / sum[3]);
    }
  }
  return result;
}

}  // namespace

std::vector<CubeTexel> checked_texels(const Environment& environment, int size, int count) {
  std::vector<CubeTexel> texels;
  const int total = cube_faces * size * size;
  for (int i = 0; i < count; ++i) {
    // The golden ratio distributes the texels evenly.
    const double place = (i + 0.5) / std::numbers::phi;
    const int t = std::min(static_cast<int>((place - std::floor(place)) * total), total - 1);
    texels.push_back({t / (size * size), t % size, t / size % size});
  }
  if (count > 0) texels.front() = cube_texel(cube_point(brightest_direction(environment)), size);
  return texels;
}

std::vector<Spectrum> integrate_cosine(const Environment& environment, const std::vector<Direction>& directions) {
  return integrate_kernel(environment, directions, environment.pieces_for_smooth_kernels(), CosineKernel{});
}

std::vector<Spectrum> integrate_lobe(const Environment& environment, const std::vector<Direction>& directions,
                                     float alpha, LobeWeight weight) {
  const float texel_width = 0.5f * pi / environment.texels_per_face();
  const int pieces = std::clamp(static_cast<int>(std::ceil(2 * texel_width / alpha)), 1, 64);
  return integrate_kernel(environment, directions, pieces, GgxKernel(alpha, weight));
}

BrdfSums integrate_brdf(double cos, double alpha) {
  constexpr int steps = 1024, turns = 256;
  const double sin = std::sqrt(1 - cos * cos), alpha2 = alpha * alpha;
  const auto masking = [&](double c) { return std::sqrt(alpha2 + (1 - alpha2) * c * c); };
  BrdfSums sums;
  for (int i = 0; i < steps; ++i) {
    // A fraction x of the normals' projected area lies below tan². Steps are denser towards grazing normals.
    const double u = (i + 0.5) / steps, x = 1 - sqr(1 - u), dx = 2 * (1 - u) / steps;
    const double tan2 = alpha2 * x / (1 - x), h_z = 1 / std::sqrt(1 + tan2), h_x = std::sqrt(1 - h_z * h_z);
    for (int k = 0; k < turns; ++k) {
      const double v_h = sin * h_x * std::cos(std::numbers::pi * (k + 0.5) / turns) + cos * h_z;
      const double l = 2 * v_h * h_z - cos;
      if (v_h <= 0 || l <= 0) continue;
      // Heitz 2014, eq. 99: G2 = 2 l v / (l masking(v) + v masking(l)).
      const double weight = 2 * l * v_h / ((l * masking(cos) + cos * masking(l)) * h_z) * dx / turns;
      const double schlick = std::pow(1 - v_h, 5);
      sums.scale += weight * (1 - schlick);
      sums.bias += weight * schlick;
    }
  }
  return sums;
}

MapError brdf_table_error(const Image& table, int checks) {
  std::vector<Spectrum> values, truth;
  const auto spectrum = [](auto scale, auto bias) {
    return Spectrum{static_cast<float>(scale), static_cast<float>(bias), 0, 0};
  };
  for (int i = 0; i < checks; ++i) {
    const double row = (i + 0.5) / checks, column = i / std::numbers::phi;
    const int y = static_cast<int>(row * table.height);
    const int x = static_cast<int>((column - std::floor(column)) * table.width);
    const double roughness = (y + 0.5) / table.height;
    const BrdfSums sums = integrate_brdf((x + 0.5) / table.width, sqr(roughness));
    values.push_back(spectrum(table.at(x, y, 0), table.at(x, y, 1)));
    truth.push_back(spectrum(sums.scale, sums.bias));
  }
  return map_error(values, truth);
}

MapError map_error(const std::vector<Spectrum>& values, const std::vector<Spectrum>& truth) {
  double differences = 0, squares = 0, largest = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double t = static_cast<double>(truth[i][c]), d = static_cast<double>(values[i][c]) - t;
      differences += d * d;
      squares += t * t;
      largest = std::max(largest, std::fabs(d));
    }
  MapError error;
  error.checks = static_cast<int>(truth.size());
  if (squares == 0) return error;
  error.rms = std::sqrt(differences / squares);
  error.max = largest / std::sqrt(squares / static_cast<double>(3 * truth.size()));
  return error;
}

}  // namespace lanthorn
