// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "path/eye_pass.h"
#include "path/walk.h"

namespace lanthorn {

/// Traces an eye path through each of columns x rows points of the window, in parallel. `make_visitor(path, index)`
/// returns the visitor of path number `index`, counted row by row.
template <class MakeVisitor>
void for_each_pilot_path(const RenderJob& job, const PathDraw& draw, int columns, int rows,
                         MakeVisitor&& make_visitor) {
  const PixelWindow& window = job.view.window;
  const Vec2 step(static_cast<float>(window.width()) / static_cast<float>(columns),
                  static_cast<float>(window.height()) / static_cast<float>(rows));
  for_each_pixel({0, 0, columns, rows}, [&](const PixelPlace& place, RayCounts& counts) {
    Sampler sampler = Sampler::for_pixel(job.settings.seed, Stream::pilot_camera, place.index, 0);
    const Vec2 centre(static_cast<float>(place.x) + 0.5f, static_cast<float>(place.y) + 0.5f);
    const CameraRay start = eye_ray(job.view, window.corner() + step * centre, sampler.next2(), draw.time);
    const PathContext path{job.scene, draw.w, sampler, counts, {job.settings.max_depth, 3}};
    walk_from_camera(path, start, job.view.medium, make_visitor(path, place.index));
  });
}

}  // namespace lanthorn
