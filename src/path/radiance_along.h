// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "path/path_visitor.h"

namespace lanthorn {

/// The eye walk of path tracing, drawn also to where light is known to come from: `guides.find(vertex)` is the Guidance
/// at a surface.
template <class Guides>
struct GuidedPathVisitor : PathVisitor {
  using PathVisitor::operator();
  GuidedContinuation operator()(const SurfaceVertex& vertex) {
    const Guidance guidance = vertex.may_scatter ? guides.find(vertex) : Guidance{};
    find_light(vertex, guidance);
    return {Continuation::go_on(), guidance};
  }

  const Guides& guides;
};

/// Radiance that arrives at the ray's origin from along it, times the ray's weight, by path tracing (Kajiya 1986) with
/// next-event estimation and multiple importance sampling (Veach 1997, chapter 9): one sample of it is added to
/// `layers`. The origin lies in `medium`. For cameras, bakers and measurements alike; `CameraRay{ray}` is any ray.
inline void radiance_along(const PathContext& path, const CameraRay& ray, MediumId medium, LightLayers& layers) {
  walk_from_camera(path, ray, medium, PathVisitor{path, layers});
}

/// The same with guided directions.
template <class Guides>
void radiance_along(const PathContext& path, const CameraRay& ray, MediumId medium, LightLayers& layers,
                    const Guides& guides) {
  walk_from_camera(path, ray, medium, GuidedPathVisitor<Guides>{{path, layers}, guides});
}

}  // namespace lanthorn
