// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/ispm/photon_tiles.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/frame.h"

namespace lanthorn {

namespace {

/// Tiles [left, right) x [top, bottom).
struct TileRange {
  int left = 0, right = 0, top = 0, bottom = 0;
};

/// Tiles along an axis from the lowest to the highest clip coordinate of a box, over w.
struct Interval {
  int begin, end;
};
Interval tiles_between(float low, float high, int pixels, int tiles) {
  constexpr float margin = 0.5f;  // pixels, for the rasteriser's rounding
  const auto tile = [&](float clip, float more) {
    const float pixel = (0.5f * clip + 0.5f) * static_cast<float>(pixels) + more;
    return std::clamp(pixel / TileGrid::side, -1.0f, static_cast<float>(tiles));
  };
  return {std::max(0, static_cast<int>(std::floor(tile(low, -margin)))),
          std::min(tiles, static_cast<int>(std::floor(tile(high, margin))) + 1)};
}

/// Tiles that the box around a photon's volume touches; all of them if it crosses the plane of the eye.
TileRange tiles_of(const GpuPhoton& photon, const Mat4& to_clip, const PhotonVolume& volume, const TileGrid& grid) {
  const Frame frame{photon.surface_normal()};
  const Mat4 box(glm::vec4(gpu::box_enlargement * volume.radius * frame.s, 0),
                 glm::vec4(gpu::box_enlargement * volume.radius * frame.t, 0),
                 glm::vec4(gpu::box_enlargement * volume.half_height * frame.n, 0), glm::vec4(photon.position, 1));
  const Mat4 m = to_clip * box;
  // w is the distance from the plane of the eye; its extent over the box:
  const float w_extent = std::fabs(m[0].w) + std::fabs(m[1].w) + std::fabs(m[2].w);
  if (m[3].w + w_extent <= 0) return {};
  if (m[3].w - w_extent <= 0) return {0, grid.columns(), 0, grid.rows()};
  Vec2 low(infinity), high(-infinity);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec4 p = m[3] + ((corner & 1) != 0 ? m[0] : -m[0]) + ((corner & 2) != 0 ? m[1] : -m[1]) +
                        ((corner & 4) != 0 ? m[2] : -m[2]);
    const Vec2 at(p.x / p.w, p.y / p.w);
    low = min(low, at);
    high = max(high, at);
  }
  const auto [left, right] = tiles_between(low.x, high.x, grid.width, grid.columns());
  const auto [top, bottom] = tiles_between(low.y, high.y, grid.height, grid.rows());
  return {left, right, top, bottom};
}

template <class Visit>
void for_each_tile(const TileRange& range, const TileGrid& grid, Visit&& visit) {
  for (int y = range.top; y < range.bottom; ++y)
    for (int x = range.left; x < range.right; ++x) {
      const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.columns());
      visit(row + static_cast<std::size_t>(x));
    }
}

}  // namespace

TilePhotons photons_by_tile(std::span<const GpuPhoton> photons, std::uint32_t first, const Mat4& to_clip,
                            const PhotonVolume& volume, const TileGrid& grid) {
  std::vector<TileRange> ranges(photons.size());
  constexpr std::size_t chunk = 1024;
  parallel_chunks(photons.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ranges[i] = tiles_of(photons[i], to_clip, volume, grid);
  });
  const auto tiles = static_cast<std::size_t>(grid.columns()) * static_cast<std::size_t>(grid.rows());
  TilePhotons result;
  result.begins.assign(tiles + 1, 0);
  for (const TileRange& range : ranges) for_each_tile(range, grid, [&](std::size_t t) { ++result.begins[t + 1]; });
  for (std::size_t t = 0; t < tiles; ++t) result.begins[t + 1] += result.begins[t];
  std::vector<std::uint32_t> next(result.begins.begin(), result.begins.end() - 1);
  result.entries.resize(result.begins.back());
  for (std::size_t i = 0; i < photons.size(); ++i)
    for_each_tile(ranges[i], grid, [&](std::size_t t) {
      result.entries[next[t]++] = {photons[i].position, first + static_cast<std::uint32_t>(i)};
    });
  return result;
}

}  // namespace lanthorn
