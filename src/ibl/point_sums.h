// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Sums of kernels over many points of light for many directions at once. Compilers vectorise loops over directions;
// they may not vectorise floating-point sums.
#pragma once

#include <array>
#include <cstddef>

#include "base/parallel.h"
#include "ibl/environment.h"
#include "math/vec.h"

namespace lanthorn {

/// Number of directions processed together.
inline constexpr std::size_t batch_size = 32;
using FloatBatch = std::array<float, batch_size>;

struct DirectionBatch {
  alignas(64) FloatBatch x{}, y{}, z{};
  void set(std::size_t i, const Vec3& d) {
    x[i] = d.x;
    y[i] = d.y;
    z[i] = d.z;
  }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

struct SpectrumBatch {
  alignas(64) std::array<FloatBatch, 4> v{};
  Spectrum operator[](std::size_t i) const { return {v[0][i], v[1][i], v[2][i], v[3][i]}; }
};

/// Adds flux · kernel(cos, |p - d|²) to the sum of each direction d, for a point of light at p.
template <class Kernel>
void add_point(const PointFlux& point, const Kernel& kernel, const DirectionBatch& at, SpectrumBatch& sums) {
  alignas(64) FloatBatch weight;
  for (std::size_t i = 0; i < batch_size; ++i) {
    const float dx = at.x[i] - point.direction.x, dy = at.y[i] - point.direction.y, dz = at.z[i] - point.direction.z;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    // For unit vectors; the distance is accurate where the cosine is near 1.
    weight[i] = kernel(1 - 0.5f * distance2, distance2);
  }
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t i = 0; i < batch_size; ++i) sums.v[c][i] += weight[i] * point.flux.v[c];
}

/// Lambert's kernel; its integral is pi.
struct CosineKernel {
  float operator()(float cos, float /*not needed*/) const { return cos > 0 ? cos : 0.0f; }
};

/// Calls `body(directions, set)` for all texels of a cube map, `batch_size` at a time; `set(sums)` stores the results.
template <class Body>
void for_texel_batches(CubeMap& map, Body&& body) {
  const auto n = static_cast<std::size_t>(map.size()), count = cube_faces * n * n;
  parallel_chunks(count, batch_size, [&](std::size_t, std::size_t begin, std::size_t end) {
    DirectionBatch at;
    const auto place = [&](std::size_t i) {
      return std::array{static_cast<int>(i / (n * n)), static_cast<int>(i % n), static_cast<int>(i / n % n)};
    };
    for (std::size_t i = 0; i < batch_size; ++i) {
      const auto [face, x, y] = place(std::min(begin + i, end - 1));
      at.set(i, map.direction(face, x, y));
    }
    body(at, [&](const auto& value) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto [face, x, y] = place(i);
        map.texel(face, x, y) = value(i - begin);
      }
    });
  });
  map.close_seams();
}

}  // namespace lanthorn
