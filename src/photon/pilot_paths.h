// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "path/eye_pass.h"
#include "path/path_draw.h"
#include "path/render_settings.h"
#include "path/walk.h"

namespace lanthorn {

/// Follows an eye path through each of columns x rows points of the window, in parallel. `make_visitor(index)` makes
/// the visitor of the path whose number, row by row, is `index`.
template <class MakeVisitor>
void for_each_pilot_path(const Scene& scene, const RenderSettings& settings, const PathDraw& draw, int columns,
                         int rows, MakeVisitor&& make_visitor) {
  const PixelWindow& window = settings.window;
  const Vec2 corner(static_cast<float>(window.x0), static_cast<float>(window.y0));
  const Vec2 step(static_cast<float>(window.width()) / static_cast<float>(columns),
                  static_cast<float>(window.height()) / static_cast<float>(rows));
  for_each_pixel(0, 0, columns, rows, [&](const PixelPlace& place, RayCounts& counts) {
    Sampler sampler = Sampler::for_pixel(settings.seed, Stream::pilot_camera, place.index, 0);
    const Vec2 centre(static_cast<float>(place.x) + 0.5f, static_cast<float>(place.y) + 0.5f);
    const CameraRay start = scene.camera().sample_ray(corner + step * centre, sampler.next2(), draw.time);
    walk_from_camera(scene, start, {settings.max_depth, 3}, draw.w, sampler, counts, make_visitor(place.index));
  });
}

}  // namespace lanthorn
