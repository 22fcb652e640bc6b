// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Eye paths: where they start, and loops over the pixels.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

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

/// The random numbers of an eye path of a pixel.
inline Sampler sampler_in_half(const RenderJob& job, const PixelPlace& place, const PlaceInHalf& in_half) {
  const Stream stream = in_half.half == FilmHalf::first ? Stream::camera : Stream::camera_of_second_half;
  return Sampler::for_pixel(job.settings.seed, stream, job.view.pixel_key(place.x, place.y), in_half.number);
}
/// The same of eye path `number` (`place_in_half`).
inline Sampler eye_sampler(const RenderJob& job, const PixelPlace& place, std::uint32_t number) {
  return sampler_in_half(job, place, place_in_half(number, job.settings.parts));
}

/// The start of an eye path of a pixel.
struct EyeStart {
  CameraRay camera;
  Vec2 raster{0};  ///< film position, pixels
  FilterPart filter_part = FilterPart::positive;
};
/// Random numbers of a sample's position. If the filter has lobes, the samples of each part have a sequence of their
/// own: with gaps where the other part's samples are, a sequence would be stratified less.
inline Sampler position_sampler(const RenderJob& job, const PixelPlace& place, FilmHalf half, const FilterPlace& at) {
  const auto number = static_cast<std::uint32_t>(at.number);
  return sampler_in_half(job, place, {half, number}).fork(static_cast<std::uint32_t>(at.part));
}
/// `at`: which sample of the filter it is. Draws from dimension group 0; group 1 is for the path's time and
/// wavelengths.
inline EyeStart start_eye_path(const RenderJob& job, const PixelPlace& place, FilmHalf half, const FilterPlace& at,
                               float time, Sampler& sampler) {
  const Filter& filter = job.view.filter;
  sampler.seek(0);
  Vec2 u = sampler.next2();
  if (filter.negative_share() != 0) u = position_sampler(job, place, half, at).next2();
  const Vec2 centre(static_cast<float>(place.x) + 0.5f, static_cast<float>(place.y) + 0.5f);
  const Vec2 raster = centre + filter.sample(u, at.part);
  return {eye_ray(job.view, raster, sampler.next2(), time), raster, at.part};
}
/// The same of eye path `number` (`place_in_half`).
inline EyeStart start_eye_path(const RenderJob& job, const PixelPlace& place, std::uint32_t number, float time,
                               Sampler& sampler) {
  const PlaceInHalf in_half = place_in_half(number, job.settings.parts);
  return start_eye_path(job, place, in_half.half, job.view.filter.place_of_sample(in_half.number), time, sampler);
}

/// The light of the eye paths of a pass whose photons come in blocks. Each eye path is traced once for each block, with
/// the same random numbers, and its light is kept from trace to trace.
class PartialLight {
 public:
  static constexpr std::size_t bytes_per_pixel = sizeof(LightLayers);

  /// `w` must outlive it.
  PartialLight(const PixelWindow& window, const Wavelengths& w, std::uint32_t traces)
      : layers_(traces > 1 ? static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height()) : 0,
                LightLayers(w)),
        traces_left_(traces) {}

  bool is_whole() const { return layers_.empty(); }  ///< one trace finds all of it
  bool is_last_trace() const { return traces_left_ == 1; }
  LightLayers& of(const PixelPlace& place) { return layers_[place.index]; }
  void end_trace() { --traces_left_; }

 private:
  std::vector<LightLayers> layers_;  // by pixel
  std::uint32_t traces_left_;
};

/// The eye paths of a pass.
struct EyePass {
  std::uint32_t pass = 0;
  WalkLimits limits;
  PartialLight* partial = nullptr;  ///< null: one trace finds all light
};

/// Adds one sample to each pixel: `draw(sampler, place)` gives the eye path its time and wavelengths, and
/// `trace(path, start, place, layers)` follows it and collects its light. With `EyePass::partial`, the last trace adds
/// the samples.
template <class Draw, class Trace>
RayCounts trace_eye_paths(const RenderJob& job, const EyePass& pass, const FilmPass& film, Draw&& draw_path,
                          Trace&& trace) {
  PartialLight* const partial = pass.partial && !pass.partial->is_whole() ? pass.partial : nullptr;
  const RayCounts rays = for_each_pixel(job.view.window, [&](const PixelPlace& place, RayCounts& counts) {
    film.prefetch(place.index);
    Sampler sampler = eye_sampler(job, place, pass.pass);
    const PathDraw draw = draw_path(sampler, place);
    const EyeStart start = start_eye_path(job, place, pass.pass, draw.time, sampler);
    const PathContext path{job.scene, draw.w, sampler, counts, pass.limits};
    LightLayers whole(draw.w);
    LightLayers& layers = partial ? partial->of(place) : whole;
    layers.use(draw.w);
    trace(path, start, place, layers);
    if (!partial || partial->is_last_trace()) film.add(place.index, layers.sample(start.filter_part, job.view.sensor));
  });
  if (partial) partial->end_trace();
  return rays;
}
/// The same for eye paths that each draw their own time and wavelengths.
template <class Trace>
RayCounts trace_eye_paths(const RenderJob& job, const EyePass& pass, const FilmPass& film, Trace&& trace) {
  const OwnPathDraw draw(job);
  return trace_eye_paths(
      job, pass, film, [&](Sampler& sampler, const PixelPlace&) { return draw(sampler); }, trace);
}

}  // namespace lanthorn
