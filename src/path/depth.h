// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How the depth limit counts scatterings. A scattering counts unless it sends light, on its way to the eye, through a
// medium under a surface (skin, wax). A passage under a surface, with all that happens there, thus counts once, where
// the light leaves. The rule asks only for the flight on the eye's side of the scattering: eye walks, light walks and
// connections count every path alike.
//
// `WalkState::depth` numbers vertices, `WalkState::scatterings()` are those that count. The first flight of a walk
// always counts: in light walks it stands for the emission; in eye walks, for the scattering that the camera sees.
#pragma once

#include "path/path_context.h"
#include "path/vertex.h"
#include "scene/scene.h"

namespace lanthorn {

/// Whether the vertex at the end of the walk's current flight does not count.
inline bool ends_under_surface(const Scene& scene, const WalkState& state) {
  return state.depth > 0 && state.medium != MediumId::vacuum && is_under_surface(scene, state.medium);
}
/// `WalkState::scatterings()` of a vertex on the walk's current flight or at its end.
inline int scatterings_on_flight(const Scene& scene, const WalkState& state) {
  return state.scatterings() + (ends_under_surface(scene, state) ? 0 : 1);
}
/// Numbers the vertex at the end of the walk's current flight.
inline void come_to_vertex(const Scene& scene, WalkState& state) {
  if (ends_under_surface(scene, state)) ++state.under_surface;
  ++state.depth;
}
/// Whether the depth limit allows one more scattering at the walk's vertex.
inline bool may_scatter(const PathContext& path, const WalkState& state) {
  return state.scatterings() <= path.limits.max_depth &&
         (state.under_surface == 0 || state.under_surface <= most_under_surface(path.scene));
}

/// The depth limit of light walks whose photons are used in paths of at most `max_depth` scatterings. Photons that have
/// come so far need not go on, except under a surface, where scatterings do not count.
inline int max_depth_of_photons(const Scene& scene, int max_depth) {
  return most_under_surface(scene) > 0 ? max_depth : max_depth - 1;
}

/// Whether a path through the eye vertex `v` and a light vertex at `p` with that many `scatterings`, joined by a
/// straight line, has at most `max_depth` scatterings.
template <class Vertex>
bool may_connect(const Scene& scene, const Vertex& v, const Point& p, int scatterings, int max_depth) {
  const int more = v.state.scatterings() + scatterings - max_depth;
  return more <= 0 || (more == 1 && is_under_surface(scene, medium_towards(v, p - position_of(v))));
}

}  // namespace lanthorn
