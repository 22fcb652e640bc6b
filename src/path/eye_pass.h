// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/parallel.h"
#include "film/film.h"
#include "film/filter.h"
#include "math/sampler.h"
#include "path/walk.h"
#include "scene/scene.h"

namespace lanthorn {

/// A pixel of the rendered window.
struct PixelPlace {
  int x = 0, y = 0;         ///< in the full film
  std::uint32_t index = 0;  ///< row-major in the window: the film's index
};

/// Calls `body(place, counts)` for every pixel of the window whose upper left corner is (x0, y0) in the full film, in
/// parallel over square tiles, so that neighbouring eye paths share caches. Returns the sum of the ray counts.
template <class Body>
RayCounts for_each_pixel(int x0, int y0, int width, int height, Body&& body) {
  constexpr int tile = 16;
  const int columns = (width + tile - 1) / tile, rows = (height + tile - 1) / tile;
  SharedRayCounts rays;
  parallel_for(0, columns * rows, [&](int t) {
    RayCounts counts;
    const int left = t % columns * tile, top = t / columns * tile;
    for (int y = top; y < std::min(top + tile, height); ++y)
      for (int x = left; x < std::min(left + tile, width); ++x) {
        stop_point();
        body(PixelPlace{x0 + x, y0 + y, static_cast<std::uint32_t>(y * width + x)}, counts);
      }
    rays.add(counts);
  });
  return rays.sum();
}

/// The start of an eye path. Its dimensions are those of groups 0 (film, lens) and 1 (what a path may draw for itself).
struct EyeStart {
  CameraRay camera;
  Vec2 raster{0};  ///< film position, pixels
  float filter_weight = 1;
};

inline EyeStart start_eye_path(const Scene& scene, const Filter& filter, const PixelPlace& place, float time,
                               Sampler& sampler) {
  sampler.seek(0);
  const FilterSample f = filter.sample(sampler.next2());
  const Vec2 centre(static_cast<float>(place.x) + 0.5f, static_cast<float>(place.y) + 0.5f);
  const Vec2 raster = centre + f.offset;
  CameraRay ray = scene.camera().sample_ray(raster, sampler.next2(), time);
  ray.weight *= scene.description().film.imaging_ratio;
  return {ray, raster, f.weight};
}
/// Index of a pixel that does not depend on the crop window: the key of its random numbers.
inline std::uint32_t pixel_key(const Scene& scene, const PixelPlace& place) {
  return static_cast<std::uint32_t>(place.y) * static_cast<std::uint32_t>(scene.camera().width()) +
         static_cast<std::uint32_t>(place.x);
}

}  // namespace lanthorn
