// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "path/direct_light.h"
#include "path/light_layers.h"
#include "path/walk.h"

namespace lanthorn {

/// The eye walk of path tracing: light is found by next-event estimation at each vertex and by the walk's own hits.
struct PathVisitor {
  const Scene& scene;
  const Wavelengths& w;
  Sampler& sampler;
  RayCounts& counts;
  LightLayers& layers;

  Continuation operator()(const SurfaceVertex& vertex) {
    find_light(vertex, {});
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& vertex) {
    if (!vertex.may_scatter) return Continuation::stop();
    sampler.seek(visitor_dimensions(vertex.state.depth));
    const DirectLight direct = next_event(scene, vertex, 1, w, sampler, counts);
    layers.add(class_of_next_event(vertex.state), direct.radiance, direct.dispersed);
    return Continuation::go_on();
  }
  void operator()(const GlowVertex& vertex) {
    layers.add(class_of_glow(vertex.state), vertex.state.beta * vertex.radiance, vertex.state.dispersed);
  }
  void operator()(const EscapeVertex& vertex) {
    layers.add(class_of_hit(vertex.state), hit_environment(scene, vertex, w), vertex.state.dispersed);
  }

  /// Of both techniques, at a vertex that the walk leaves with this guidance.
  void find_light(const SurfaceVertex& vertex, const Guidance& guidance) {
    layers.see(vertex);
    layers.add(class_of_hit(vertex.state), hit_emitter(scene, vertex, w), vertex.state.dispersed);
    if (!vertex.may_scatter || !has_non_delta(vertex.at.bsdf)) return;
    sampler.seek(visitor_dimensions(vertex.state.depth));
    const DirectLight direct = next_event(scene, vertex, 1, w, sampler, counts, guidance);
    layers.add(class_of_next_event(vertex.state), direct.radiance, direct.dispersed);
  }
};

/// Light of glowing media alone, along a branch from where photons stand for all other light: media emit no photons.
struct GlowVisitor {
  LightLayers& layers;

  Continuation operator()(const SurfaceVertex&) const { return Continuation::go_on(); }
  Continuation operator()(const MediumVertex&) const { return Continuation::go_on(); }
  void operator()(const GlowVertex& vertex) const {
    layers.add(class_of_glow(vertex.state), vertex.state.beta * vertex.radiance, vertex.state.dispersed);
  }
  void operator()(const EscapeVertex&) const {}
};

/// Adds that of a vertex's non-delta lobes. `sampler` is the walk's that got there.
inline void add_glow(const Scene& scene, const SurfaceVertex& vertex, const WalkLimits& limits, const Wavelengths& w,
                     const Sampler& sampler, RayCounts& counts, LightLayers& layers) {
  if (!scene.has_glowing_media()) return;
  Sampler own = sampler.fork(visitor_dimensions(vertex.state.depth));
  branch_walk<Transport::radiance>(scene, vertex, Continuation::go_on(), limits, w, own, counts, GlowVisitor{layers});
}

}  // namespace lanthorn
