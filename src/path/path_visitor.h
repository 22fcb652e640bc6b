// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "path/direct_light.h"
#include "path/light_layers.h"
#include "path/transmittance.h"
#include "path/walk.h"

namespace lanthorn {

/// The eye walk of path tracing. It finds light by next-event estimation at each vertex and by hitting emitters.
struct PathVisitor {
  const PathContext& path;
  LightLayers& layers;
  RayLight ray_light = {};

  Continuation operator()(const SurfaceVertex& vertex) {
    find_light(vertex, Continuation::go_on());
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& vertex) {
    layers.see(vertex);
    if (!vertex.may_scatter) return Continuation::stop();
    path.sampler.seek(visitor_dimensions(vertex.state.depth));
    const DirectLight direct = ray_light.next_event_at(path, vertex);
    layers.add(class_of_next_event(vertex.state), direct.radiance, direct.dispersed);
    return Continuation::go_on();
  }
  void operator()(const MediumRay& ray) {
    const DirectLight direct = ray_light.along(path, ray);
    if (direct.radiance.is_black()) return;
    layers.see(ray);
    layers.add(class_of_next_event(ray.state), direct.radiance, direct.dispersed);
  }
  void operator()(const EmissionVertex& vertex) { layers.add_hit(vertex, hit_lights(path, vertex)); }
  void operator()(const EscapeVertex& vertex) { layers.add_hit(vertex, hit_lights(path, vertex)); }

  /// Adds the light of both techniques at a vertex that the walk leaves with this answer.
  template <class Answer>
  void find_light(const SurfaceVertex& vertex, const Answer& answer) {
    layers.see(vertex);
    layers.add_hit(vertex, hit_lights(path, vertex));
    if (!vertex.may_scatter || !has_non_delta(vertex.at.bsdf)) return;
    path.sampler.seek(visitor_dimensions(vertex.state.depth));
    const DirectLight direct = next_event(path, vertex, answer);
    layers.add(class_of_next_event(vertex.state), direct.radiance, direct.dispersed);
  }
};

/// Collects the emission of media that are not lights, along a branch from a vertex where photons account for all other
/// light.
struct UnlitEmissionVisitor {
  const PathContext& path;
  LightLayers& layers;

  Continuation operator()(const SurfaceVertex&) const { return Continuation::go_on(); }
  Continuation operator()(const MediumVertex&) const { return Continuation::go_on(); }
  void operator()(const EmissionVertex& vertex) const {
    if (!path.scene.volume_light(vertex.state.medium)) layers.add_hit(vertex, hit_lights(path, vertex));
  }
  void operator()(const EscapeVertex&) const {}
};

/// Adds the light of infinite lights, times `factor`, that comes straight to a vertex from a direction that the closure
/// samples: the second technique beside next-event estimation where the walk ends (`branches_to_sky`).
inline void add_sky(const PathContext& path, const SurfaceVertex& vertex, LightLayers& layers, float factor = 1) {
  if (path.scene.infinite_lights().empty()) return;
  const std::uint32_t dimensions = walk_dimensions(vertex.state.depth);
  Sampler own = path.sampler.fork(dimensions);
  WalkState state;
  const std::optional<Ray> ray = branch_ray<Transport::radiance>(path.with(own), vertex, Continuation::go_on(), state);
  if (!ray) return;
  state.beta *= passage(path.with(own), *ray, state.medium, dimensions).transmittance * factor;
  if (state.beta.is_black()) return;
  const EscapeVertex sky{state, ray->direction};
  layers.add_hit(sky, hit_lights(path, sky));
}

/// Adds the emission of media that are not lights, as far as a vertex's wide lobes scatter it to the eye. `path`: the
/// path of the walk that reached the vertex.
inline void add_unlit_emission(const PathContext& path, const SurfaceVertex& vertex, const LobeSplit& split,
                               LightLayers& layers) {
  if (!path.scene.has_unlit_emission()) return;
  Sampler own = path.sampler.fork(visitor_dimensions(vertex.state.depth));
  branch_walk<Transport::radiance>(path.with(own), vertex, WideContinuation{{}, split},
                                   UnlitEmissionVisitor{path, layers});
}

}  // namespace lanthorn
