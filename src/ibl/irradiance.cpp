// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "ibl/irradiance.h"

#include "ibl/point_sums.h"

namespace lanthorn {

std::vector<PointFlux> points_of(const CubeMap& map, const Environment& environment) {
  const std::vector<float> solid_angles = cube_solid_angles(map.size());
  constexpr float sun_spacing = 0.02f;
  std::vector<PointFlux> points = environment.sun_points(sun_spacing);
  const int n = map.size();
  for (int face = 0; face < cube_faces; ++face)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const float omega =
            solid_angles[static_cast<std::size_t>(y) * static_cast<std::size_t>(n) + static_cast<std::size_t>(x)];
        Spectrum flux = omega * map.texel(face, x, y);
        flux[3] = omega;
        points.push_back({map.direction(face, x, y), flux});
      }
  return points;
}

CubeMap irradiance_map(const std::vector<PointFlux>& points, int size) {
  CubeMap map(size);
  for_texel_batches(map, [&](const DirectionBatch& at, auto&& store) {
    SpectrumBatch sums;
    for (const PointFlux& point : points) add_point(point, CosineKernel{}, at, sums);
    store([&](std::size_t i) {
      const Spectrum sum = sums[i];
      return Spectrum{sum[0], sum[1], sum[2], 0} / sum[3];
    });
  });
  return map;
}

}  // namespace lanthorn
