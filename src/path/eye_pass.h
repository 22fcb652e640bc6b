// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Eye paths: where they start, and loops over the pixels.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/parallel.h"
#include "film/film_pass.h"
#include "math/sampler.h"
#include "path/light_layers.h"
#include "path/path_context.h"
#include "path/path_draw.h"
#include "path/render_job.h"

namespace lanthorn {

/// A pixel of the rendered window.
struct PixelPlace {
  int x = 0, y = 0;         ///< in the full film
  std::uint32_t index = 0;  ///< row-major in the window: the film's index
};

/// Calls `body(place, counts)` for every pixel of the window, in parallel over square tiles, so that neighbouring eye
/// paths share caches. Returns the sum of the ray counts.
template <class Body>
RayCounts for_each_pixel(const PixelWindow& window, Body&& body) {
  constexpr int tile = 16;
  const int width = window.width(), height = window.height();
  const int columns = (width + tile - 1) / tile, rows = (height + tile - 1) / tile;
  SharedRayCounts rays;
  parallel_for(0, columns * rows, [&](int t) {
    RayCounts counts;
    const int left = t % columns * tile, top = t / columns * tile;
    for (int y = top; y < std::min(top + tile, height); ++y)
      for (int x = left; x < std::min(left + tile, width); ++x) {
        stop_point();
        body(PixelPlace{window.x0 + x, window.y0 + y, static_cast<std::uint32_t>(y * width + x)}, counts);
      }
    rays.add(counts);
  });
  return rays.sum();
}

/// The ray of an eye path from a place on the film.
inline CameraRay eye_ray(const View& view, const Vec2& raster, const Vec2& u_lens, float time) {
  CameraRay ray = view.camera.sample_ray(raster, u_lens, time);
  ray.weight *= view.imaging_ratio;
  return ray;
}

/// The random numbers of eye path `number` of a pixel (`PlaceInHalf`).
inline Sampler eye_sampler(const RenderJob& job, const PixelPlace& place, std::uint32_t number) {
  const PlaceInHalf in_half = place_in_half(number, job.settings.parts);
  const Stream stream = in_half.half == FilmHalf::first ? Stream::camera : Stream::camera_of_second_half;
  return Sampler::for_pixel(job.settings.seed, stream, job.view.pixel_key(place.x, place.y), in_half.number);
}

/// The start of an eye path of a pixel. Draws from dimension group 0; group 1 is for the path's time and wavelengths.
struct EyeStart {
  CameraRay camera;
  Vec2 raster{0};  ///< film position, pixels
  float filter_weight = 1;
};
inline EyeStart start_eye_path(const View& view, const PixelPlace& place, float time, Sampler& sampler) {
  sampler.seek(0);
  const FilterSample f = view.filter.sample(sampler.next2());
  const Vec2 centre(static_cast<float>(place.x) + 0.5f, static_cast<float>(place.y) + 0.5f);
  const Vec2 raster = centre + f.offset;
  return {eye_ray(view, raster, sampler.next2(), time), raster, f.weight};
}

/// The eye paths of a pass.
struct EyePass {
  std::uint32_t pass = 0;
  WalkLimits limits;
};

/// Adds one sample to each pixel: `draw(sampler)` gives the eye path its time and wavelengths, and
/// `trace(path, start, place, layers)` follows it and collects its light.
template <class Draw, class Trace>
RayCounts trace_eye_paths(const RenderJob& job, const EyePass& pass, const FilmPass& film, Draw&& draw_path,
                          Trace&& trace) {
  return for_each_pixel(job.view.window, [&](const PixelPlace& place, RayCounts& counts) {
    film.prefetch(place.index);
    Sampler sampler = eye_sampler(job, place, pass.pass);
    const PathDraw draw = draw_path(sampler);
    const EyeStart start = start_eye_path(job.view, place, draw.time, sampler);
    LightLayers layers(draw.w);
    trace(PathContext{job.scene, draw.w, sampler, counts, pass.limits}, start, place, layers);
    film.add(place.index, layers.sample(start.filter_weight, job.view.sensor));
  });
}
/// The same for eye paths whose times and wavelengths are their own.
template <class Trace>
RayCounts trace_eye_paths(const RenderJob& job, const EyePass& pass, const FilmPass& film, Trace&& trace) {
  return trace_eye_paths(job, pass, film, OwnPathDraw(job), trace);
}

}  // namespace lanthorn
