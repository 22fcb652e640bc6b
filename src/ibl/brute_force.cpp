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
      brightest = environment.direction_at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    }
  return brightest;
}

template <class Kernel>
SpectrumLanes sum_rows(const Environment& environment, int begin, int end, int pieces, const Kernel& kernel,
                       const DirectionLanes& at) {
  SpectrumLanes sums;
  const float step = 1 / static_cast<float>(pieces);
  for (int y = begin; y < end; ++y) {
    // Sums of one row at a time, so that small numbers are not lost in large ones.
    SpectrumLanes row;
    for (int x = 0; x < environment.width(); ++x) {
      const float omega = environment.solid_angle(x, y) * step * step;
      Spectrum flux = omega * environment.texel(x, y);
      flux[3] = omega;
      for (int j = 0; j < pieces; ++j)
        for (int i = 0; i < pieces; ++i) {
          const auto place = [&](int texel, int piece) {
            return static_cast<float>(texel) + (static_cast<float>(piece) + 0.5f) * step;
          };
          add_point({environment.direction_at(place(x, i), place(y, j)), flux}, kernel, at, row);
        }
    }
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t i = 0; i < lanes; ++i) sums.v[c][i] += row.v[c][i];
  }
  return sums;
}

template <class Kernel>
std::vector<Spectrum> integrate_kernel(const Environment& environment, const std::vector<Direction>& directions,
                                       int pieces, const Kernel& kernel) {
  std::vector<Spectrum> result;
  for (std::size_t first = 0; first < directions.size(); first += lanes) {
    DirectionLanes at;
    for (std::size_t i = 0; i < lanes; ++i) at.set(i, directions[std::min(first + i, directions.size() - 1)]);
    constexpr std::size_t rows_each = 16;
    const auto rows = static_cast<std::size_t>(environment.height());
    std::vector<SpectrumLanes> parts((rows + rows_each - 1) / rows_each);
    parallel_chunks(rows, rows_each, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      parts[chunk] = sum_rows(environment, static_cast<int>(begin), static_cast<int>(end), pieces, kernel, at);
    });
    for (std::size_t i = 0; i < std::min(lanes, directions.size() - first); ++i) {
      Spectrum sum;
      for (const SpectrumLanes& part : parts) sum += part[i];
      result.push_back(Spectrum{sum[0], sum[1], sum[2], 0} / sum[3]);
    }
  }
  return result;
}

}  // namespace

std::vector<CheckedTexel> checked_texels(const Environment& environment, int size, int count) {
  std::vector<CheckedTexel> texels;
  const int total = cube_faces * size * size;
  for (int i = 0; i < count; ++i) {
    // The golden ratio spreads them.
    const double place = (i + 0.5) / std::numbers::phi;
    const int t = std::min(static_cast<int>((place - std::floor(place)) * total), total - 1);
    texels.push_back({t / (size * size), t % size, t / size % size});
  }
  if (count > 0) {
    const CubePoint p = cube_point(brightest_direction(environment));
    const auto texel_at = [&](float v) {
      return std::clamp(static_cast<int>(v * static_cast<float>(size)), 0, size - 1);
    };
    texels.front() = {p.face, texel_at(p.at.x), texel_at(p.at.y)};
  }
  return texels;
}

std::vector<Spectrum> integrate_cosine(const Environment& environment, const std::vector<Direction>& directions) {
  return integrate_kernel(environment, directions, 1, CosineKernel{});
}

std::vector<Spectrum> integrate_lobe(const Environment& environment, const std::vector<Direction>& directions,
                                     float alpha, LobeWeight weight) {
  const float texel_width = 0.5f * pi / environment.texels_per_face();
  const int pieces = std::clamp(static_cast<int>(std::ceil(2 * texel_width / alpha)), 1, 64);
  return integrate_kernel(environment, directions, pieces, GgxKernel(alpha, weight));
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
