// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What the progressive photon mappers share: the photon map of a pass, and the eye paths that gather from it. They
// differ in the radius of a gather, and in which random numbers an eye path has.
#pragma once

#include "index/hash_grid.h"
#include "integrators/integrator.h"
#include "path/path_draw.h"
#include "path/path_visitor.h"
#include "photon/emission_choice.h"
#include "photon/kernels.h"
#include "photon/photon_gather.h"
#include "photon/photon_map.h"
#include "photon/photon_pass.h"

namespace lanthorn {

using PassMap = PhotonMap<HashGrid>;

inline const ParameterInfo kernel_info{"kernel", "epanechnikov",
                                       "density estimation kernel: box, cone, epanechnikov, gaussian"};
/// Reads it.
Kernel kernel_parameter(const Parameters& parameters);

/// What all photon methods leave out of a scene's light; empty if nothing.
std::string photon_limitation(const Scene& scene);

/// The photons of a pass, with the time and wavelengths that its eye paths share.
struct PassPhotons {
  PathDraw draw;
  PassMap map;
  PassReport report;  ///< of the photons' part of the pass
};

/// Where they come from. Keeps its memory from pass to pass.
class PassPhotonSource {
 public:
  explicit PassPhotonSource(const Parameters& parameters) : choice_(emission_choice(parameters)) {}

  /// Before the first radius is chosen, which depends on where photons start.
  void prepare(const RenderJob& job) { guide_ = choose_emission(choice_, PhotonUse::indirect, job); }
  const EmissionGuide* guide() const { return guide_ ? &*guide_ : nullptr; }
  /// Traces the photons and builds their map for gathers of `support` metres or less. Ends by beginning the phase of
  /// eye paths.
  PassPhotons trace(const RenderJob& job, std::uint32_t pass, float support, const PhaseObserver& begin);

 private:
  EmissionChoice choice_;
  std::optional<EmissionGuide> guide_;
  PhotonTracer tracer_;
};

/// At each vertex: next-event estimation for direct light; then, with a probability that depends on the lobes, indirect
/// light from the photons, or else the walk goes on. Photons are in proportion to that probability, the walk's
/// non-delta light to its complement: together they are all of it. Delta lobes have the walk alone.
///
/// `gather(vertex, delta_light_weight)` gives the GatheredLight; see `GatherSettings` for the weight.
template <class Gather>
struct GatherVisitor : PathVisitor {
  Gather gather;

  // Photons are stored on surfaces alone: elsewhere the walk goes on as a path tracer's.
  using PathVisitor::operator();
  Continuation operator()(const SurfaceVertex& vertex) {
    const WalkState& state = vertex.state;
    layers.see(vertex);
    layers.add(class_of_hit(state), hit_emitter(path, vertex), state.dispersed);
    if (!vertex.may_scatter) return Continuation::stop();
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();

    // Photons are not recorded for eye paths of more scatterings: from there on the walk finds the light alone.
    const bool photons_reach = state.depth <= PhotonFlags::most_eye_scatterings + 1;
    const float p = photons_reach ? gather_probability(lobe_weights(vertex.at.bsdf, vertex.wi_local)) : 0.0f;
    path.sampler.seek(visitor_dimensions(state.depth));
    const DirectLight direct = next_event(path, vertex, 1 - p);
    layers.add(class_of_next_event(state), direct.radiance, direct.dispersed);
    if (path.sampler.next() >= p) return {1 - p, 1 - p};

    const GatheredLight light = gather(vertex, 1 / p);
    layers.add(state.non_delta == 0 ? PathClass::caustic : PathClass::indirect, light.caustic, false);
    layers.add(PathClass::indirect, light.indirect, false);
    add_volumetric_emission(path, vertex, layers);
    return Continuation::stop();
  }
};

// Clang 14 deduces nothing of aggregates by itself.
template <class Gather>
GatherVisitor(PathVisitor, Gather) -> GatherVisitor<Gather>;

}  // namespace lanthorn
