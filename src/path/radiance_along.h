// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "path/eye_pass.h"
#include "path/path_visitor.h"

namespace lanthorn {

/// The eye walk of path tracing with path guiding. `guides.find(vertex)` is the Guidance at a surface.
template <class Guides>
struct GuidedPathVisitor : PathVisitor {
  using PathVisitor::operator();
  GuidedContinuation operator()(const SurfaceVertex& vertex) {
    const GuidedContinuation answer{{}, vertex.may_scatter ? guides.find(vertex) : Guidance{}};
    find_light(vertex, answer);
    return answer;
  }

  const Guides& guides;
};

/// Adds to `layers` one sample of the radiance that arrives along the ray at its origin, times the ray's weight, by
/// path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling (Veach 1997, chapter 9). The
/// origin lies in `medium`. For cameras, bakers and measurements; `CameraRay{ray}` makes any ray one of weight 1.
inline void radiance_along(const PathContext& path, const CameraRay& ray, MediumId medium, LightLayers& layers) {
  walk_from_camera(path, ray, medium, PathVisitor{path, layers});
}

/// The same with guided directions.
template <class Guides>
void radiance_along(const PathContext& path, const CameraRay& ray, MediumId medium, LightLayers& layers,
                    const Guides& guides) {
  walk_from_camera(path, ray, medium, GuidedPathVisitor<Guides>{{path, layers}, guides});
}

/// A pass of path tracing: one sample for each pixel. `guides`: none, or one as above.
template <class... Guides>
RayCounts trace_paths(const RenderJob& job, const EyePass& pass, const FilmPass& film, const Guides&... guides) {
  return trace_eye_paths(job, pass, film,
                         [&](const PathContext& path, const EyeStart& start, const PixelPlace&, LightLayers& layers) {
                           radiance_along(path, start.camera, job.view.medium, layers, guides...);
                         });
}

}  // namespace lanthorn
