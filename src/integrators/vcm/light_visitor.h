// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Step 1 of vertex connection and merging: light paths.
#pragma once

#include <cstdint>
#include <variant>

#include "integrators/vcm/vcm_pass.h"
#include "path/connections.h"
#include "path/depth.h"
#include "path/lens_connection.h"
#include "photon/flux_classes.h"
#include "photon/photon_pass.h"

namespace lanthorn {

/// A vertex of a light path that is connected to the lens.
struct LightArrival {
  const std::variant<const SurfaceVertex*, const MediumVertex*> vertex;
  const Subpath& subpath;
  const Wavelengths& w;
  PathLayers layers;

  /// `bidirectional`: of the place on the film that receives the light.
  TechniqueSum densities(const Bidirectional& bidirectional, const LensLight& seen) const {
    return std::visit([&](const auto* v) { return densities_of_seen(bidirectional, *v, subpath, seen); }, vertex);
  }
};

/// Keeps the vertices of a light path, and connects them to the lens: `see(LightArrival, LensLight,
/// PlaceEffort)`.
template <class See>
class LightVisitor {
 public:
  LightVisitor(const PathContext& path, const VcmPass& pass, std::uint32_t light, float time, const FilmPass* film,
               LightVertices::Chunk& chunk, const See& see)
      : path_(path),
        pass_(pass),
        light_(light),
        time_(time),
        film_(film),
        chunk_(chunk),
        see_(see),
        subpath_(pass.bidirectional.techniques) {}

  // The path starts (TR eqs. 31-33).
  void operator()(const EmissionSample& emission) {
    keeps_beams_ = pass_.beam_share > 0 && keeps_beams(path_.sampler, pass_.beam_share);
    subpath_.begin_at_light(light_, emission, pass_.bidirectional.emission);
  }
  // It has come to a vertex (TR eqs. 34-36; through delta lobes eqs. 53-55).
  Continuation operator()(const SurfaceVertex& v) {
    subpath_.arrive(path_, v);
    if (v.may_scatter && has_non_delta(v.at.bsdf)) keep(v);
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& v) {
    subpath_.arrive(path_, v);
    if (v.may_scatter) keep(v);
    return Continuation::go_on();
  }
  void operator()(const FlownSegment& flight) {
    if (flight.state.medium == MediumId::vacuum) return;
    if (keeps_beams_ && scatterings_on_flight(path_.scene, flight.state) <= pass_.max_depth())
      if (auto beam = keep_beam(path_, flight, time_, pass_.beam_share, subpath_)) chunk_.beams.push_back(*beam);
    subpath_.fly(flight);
  }
  void operator()(const EscapeVertex&) {}

 private:
  // Keeps the vertex, and connects it to the lens (TR eqs. 46, 47).
  template <class Vertex>
  void keep(const Vertex& v) {
    LightVertex& kept = chunk_.vertices.emplace_back(keep_vertex(v, subpath_));
    kept.flux_class = pass_.class_of_flux(flux_of(v.state.beta, v.state.dispersed, path_.w));
    kept.meet_others(path_.w);
    if (!pass_.sees || !pass_.shows(v.state.depth + 1, 1)) return;
    const auto lens = find_lens(path_, pass_.job.view, v);
    if (!lens) return;
    const PlaceEffort there = pass_.effort.at(lens->raster);
    if (!there.sees) return;
    if (film_) film_->prefetch_splats(pass_.job.view.window.pixel_at(lens->raster));
    if (const auto seen = connect_to_lens(path_, pass_.job.view, v, *lens))
      see_(LightArrival{&v, subpath_, path_.w, layers_of_splat(v)}, *seen, there);
  }

  const PathContext& path_;
  const VcmPass& pass_;
  std::uint32_t light_;
  float time_;
  bool keeps_beams_ = false;
  const FilmPass* film_;
  LightVertices::Chunk& chunk_;
  const See& see_;
  Subpath subpath_;
};

/// Traces the light paths of a pass. `film`: receives splats, and is prefetched; null if there will be none.
template <class See>
RayCounts trace_light_paths(const VcmPass& pass, const FilmPass* film, const See& see) {
  pass.vertices.begin(pass.light_paths.chunk_count());
  const WalkLimits limits{.max_depth = pass.max_depth()};
  return pass.light_paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t c) {
    LightVertices::Chunk& chunk = pass.vertices.chunk(c);
    const PathDraw own = pass.draw.of_path(sampler);
    const PathContext path{pass.job.scene, own.w, sampler, counts, limits};
    const auto see_in_chunk = [&](const LightArrival& light, const LensLight& seen, const PlaceEffort& there) {
      see(light, seen, there, c);
    };
    walk_from_light(path, start, own.time, LightVisitor(path, pass, start.index, own.time, film, chunk, see_in_chunk));
    chunk.ends.push_back(static_cast<std::uint32_t>(chunk.vertices.size()));
  });
}

}  // namespace lanthorn
