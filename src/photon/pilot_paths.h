// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "path/eye_pass.h"
#include "path/walk.h"

namespace lanthorn {

/// Traces an eye path through each of columns x rows points of an area of the film, in parallel. There are at most as
/// many as it has pixels. `make_visitor(path, camera_ray, index)` returns the visitor of path number `index`, counted
/// row by row. The path through a pixel's centre does not depend on the area.
template <class MakeVisitor>
void for_each_pilot_path(const RenderJob& job, const PassDraw& draw, const PixelWindow& area, int columns, int rows,
                         MakeVisitor&& make_visitor) {
  const Vec2 step(static_cast<float>(area.width()) / static_cast<float>(columns),
                  static_cast<float>(area.height()) / static_cast<float>(rows));
  for_each_pixel({0, 0, columns, rows}, [&](const PixelPlace& place, RayCounts& counts) {
    const Vec2 centre(static_cast<float>(place.x) + 0.5f, static_cast<float>(place.y) + 0.5f);
    const Vec2 raster = area.corner() + step * centre;
    const std::uint32_t pixel = job.view.pixel_key(static_cast<int>(raster.x), static_cast<int>(raster.y));
    Sampler sampler = Sampler::for_pixel(job.settings.seed, Stream::pilot_camera, pixel, 0);
    const Vec2 lens = sampler.next2();
    const PathDraw own = draw.of_path(sampler);
    const CameraRay start = eye_ray(job.view, raster, lens, own.time);
    const PathContext path{job.scene, own.w, sampler, counts, {job.settings.max_depth, 3}};
    walk_from_camera(path, start, job.view.medium, make_visitor(path, start.ray, place.index));
  });
}

}  // namespace lanthorn
