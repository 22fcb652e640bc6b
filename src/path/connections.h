// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The techniques of bidirectional path tracing (Veach 1997, chapter 10). Each returns what it found and the densities
// of all techniques that can make the same path; the caller weighs it.
#pragma once

#include <optional>

#include "path/direct_light.h"
#include "path/lens_connection.h"
#include "path/light_vertices.h"
#include "path/subpath.h"

namespace lanthorn {

/// State that all techniques share, for a pass or for one pixel of it.
struct Bidirectional {
  const View& view;
  Techniques techniques;
  const EmissionDensities& emission;

  float merging_at(const SurfacePoint& at) const { return merges_at(at) ? techniques.merging : 0.0f; }
};

/// What a technique found by one path.
struct Contribution {
  Spectrum light;          ///< radiance times state.beta, without MIS weight
  bool dispersed = false;  ///< as of DirectLight
  TechniqueSum densities;

  Spectrum weighted(const Techniques& t) const { return light * densities.weight(t); }
};

/// Copies a vertex of a light walk, so that it can be kept for the pass.
template <class Vertex>
LightVertex keep_vertex(const Vertex& v, const Subpath& subpath);
/// Keeps a light walk's flight through a medium, up to the next surface, as far as the walk could have scattered.
/// `share`: fraction of the light paths whose flights are kept. Nullopt if the walk could scatter nowhere. `subpath`
/// departs for the flight.
std::optional<LightBeam> keep_beam(const PathContext& path, const FlownSegment& flight, float time, float share,
                                   Subpath& subpath);

// The techniques at a vertex where `subpath` has arrived.

/// Densities of a light that the eye walk has hit; `state` is that of its last vertex.
TechniqueSum densities_of_hit(const PathContext& path, const Bidirectional& pass, const WalkState& state,
                              const Subpath& subpath, const LightHit& hit);
/// Calls `found(Contribution)` for each light that the eye walk has hit (`for_each_hit`). If it has left its last
/// vertex for an EscapeVertex or EmissionVertex, so has `subpath` (`Subpath::escape`).
template <class Vertex, class Found>
void hit_lights(const PathContext& path, const Bidirectional& pass, const Vertex& v, const Subpath& subpath,
                Found&& found) {
  for_each_hit(path, v, [&](const LightHit& hit) {
    found(Contribution{hit.radiance, v.state.dispersed, densities_of_hit(path, pass, v.state, subpath, hit)});
  });
}
/// Next-event estimation at an eye vertex. Draws from the visitor's dimensions.
template <class Vertex>
std::optional<Contribution> next_event(const PathContext& path, const Bidirectional& pass, const Vertex& v,
                                       const Subpath& subpath);
/// Connects an eye vertex to a light vertex. Light paths carry 1 / `techniques.light_paths` of the light each; the
/// result estimates all of it.
template <class Vertex>
std::optional<Contribution> connect(const PathContext& path, const Bidirectional& pass, const Vertex& v,
                                    const Subpath& subpath, const LightVertex& other);
/// Densities of a light vertex that is connected to the lens. `pass` belongs to the pixel that receives the light.
template <class Vertex>
TechniqueSum densities_of_seen(const Bidirectional& pass, const Vertex& v, const Subpath& subpath,
                               const LensLight& seen);

}  // namespace lanthorn
