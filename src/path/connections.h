// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The techniques of bidirectional path tracing (Veach 1997, chapter 10), each with its MIS weight among all of them.
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
  TechniqueSum* weighed = nullptr;  ///< receives the densities behind each weight; may be null

  float weigh(const TechniqueSum& sum) const {
    if (weighed) *weighed = sum;
    return sum.weight(techniques);
  }
  float merging_at(const SurfacePoint& at) const { return merges_at(at) ? techniques.merging : 0.0f; }
};

/// Copies a vertex of a light walk, so that it can be kept for the pass.
LightVertex keep_vertex(const SurfaceVertex& v, const Subpath& subpath);
LightVertex keep_vertex(const MediumVertex& v, const Subpath& subpath);
/// Keeps a light walk's flight through a medium, up to the next surface, as far as the walk could have scattered.
/// `share`: fraction of the light paths whose flights are kept. Nullopt if the walk could scatter nowhere. `subpath`
/// departs for the flight.
std::optional<LightBeam> keep_beam(const PathContext& path, const FlownSegment& flight, float time, float share,
                                   Subpath& subpath);

// Each function returns radiance times state.beta times the technique's MIS weight. `subpath` has arrived at the
// vertex.

/// The eye walk has hit an emitter.
Spectrum hit_emitter(const PathContext& path, const Bidirectional& pass, const SurfaceVertex& v,
                     const Subpath& subpath);
/// The eye walk has left the scene: light of infinite lights.
Spectrum hit_environment(const PathContext& path, const Bidirectional& pass, const EscapeVertex& v,
                         const Subpath& subpath);
/// The eye walk's ray crosses a medium that emits, after leaving the vertex where `subpath` has arrived.
Spectrum hit_volume_emission(const PathContext& path, const Bidirectional& pass, const EmissionVertex& v,
                             Subpath subpath);

/// Next-event estimation at an eye vertex. Draws from the visitor's dimensions.
DirectLight next_event(const PathContext& path, const Bidirectional& pass, const SurfaceVertex& v,
                       const Subpath& subpath);
DirectLight next_event(const PathContext& path, const Bidirectional& pass, const MediumVertex& v,
                       const Subpath& subpath);

/// Connects an eye vertex to a light vertex. Light paths carry 1 / `techniques.light_paths` of the light each; the
/// result estimates all of it.
DirectLight connect(const PathContext& path, const Bidirectional& pass, const SurfaceVertex& v, const Subpath& subpath,
                    const LightVertex& other);
DirectLight connect(const PathContext& path, const Bidirectional& pass, const MediumVertex& v, const Subpath& subpath,
                    const LightVertex& other);

/// MIS weight of a light vertex that is connected to the lens. `pass` belongs to the pixel that receives the light.
float weight_of_seen(const Bidirectional& pass, const SurfaceVertex& v, const Subpath& subpath, const LensLight& seen);
float weight_of_seen(const Bidirectional& pass, const MediumVertex& v, const Subpath& subpath, const LensLight& seen);

}  // namespace lanthorn
