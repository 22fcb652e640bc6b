// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The common parts of the progressive photon mappers: the photon map of a pass, and the eye paths that gather from it.
// The methods differ in the radius of a gather and in the random numbers of an eye path.
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
#include "photon/pilot_radius.h"

namespace lanthorn {

inline const ParameterInfo kernel_info{"kernel", "epanechnikov",
                                       "density estimation kernel: box, cone, epanechnikov, gaussian"};
/// Reads the parameter "kernel".
Kernel kernel_parameter(const Parameters& parameters);

/// Message about light of the scene that photon methods do not find. Empty if they find all light.
std::string photon_limitation(const Scene& scene);

/// The photons of a pass, with what its eye paths share.
struct PassPhotons {
  PassDraw draw;
  std::vector<PhotonMap<HashGrid>> maps;  ///< by class (`FluxClasses`)
  PassReport report;                      ///< of the photons' part of the pass

  /// The sum of `gather(map, radius_factor)` over the classes of photons. `radius`: of the first class in this pass.
  template <class Gather>
  GatheredLight gather(const FirstRadius& first, std::uint32_t pixel, float radius, Gather&& gather) const {
    GatheredLight sum;
    for (std::size_t c = 0; c < maps.size(); ++c)
      sum += gather(maps[c], first.class_factor(static_cast<int>(c), pixel, radius));
    return sum;
  }
};

/// Traces the photons of each pass. Reuses its memory from pass to pass.
class PassPhotonSource {
 public:
  explicit PassPhotonSource(const Parameters& parameters) : choice_(emission_choice(parameters)) {}

  /// Chooses the emission guide. Call it before the first radius is measured, which depends on the guide.
  void prepare(const RenderJob& job) { emission_ = choose_emission(choice_, PhotonUse::indirect, job); }
  const Emission& emission() const { return emission_; }
  /// Traces the photons and builds the maps of their classes for gathers of `support` metres or less, times the radius
  /// factor of the class. At the end it announces the phase of eye paths.
  PassPhotons trace(const RenderJob& job, std::uint32_t pass, const FluxClasses& classes, float support,
                    const PhaseObserver& begin);

 private:
  EmissionChoice choice_;
  Emission emission_;
  PhotonTracer tracer_;
};

/// The eye path. At each vertex, next-event estimation finds direct light. Then, with a probability p that depends on
/// the lobes (gather_probability), photons give the indirect light; otherwise the walk continues. Neither is divided by
/// its probability: photons count with the factor p and the walk's non-delta light with 1 - p, which sum to one. The
/// light of delta lobes is found by the walk alone and is divided by 1 - p.
///
/// `gather(vertex, delta_light_weight)` returns the GatheredLight; see `GatherSettings` for the weight.
template <class Gather>
struct GatherVisitor : PathVisitor {
  Gather gather;

  // Photons are stored on surfaces only. In media the walk continues as that of a path tracer.
  using PathVisitor::operator();
  Continuation operator()(const SurfaceVertex& vertex) {
    const WalkState& state = vertex.state;
    layers.see(vertex);
    layers.add_hit(vertex, hit_emitter(path, vertex));
    if (!vertex.may_scatter) return Continuation::stop();
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();

    // Photon records do not count more scatterings of the eye path. Beyond, the walk alone finds the light.
    const bool photons_reach = state.depth <= PhotonFlags::most_eye_scatterings + 1;
    const float p = photons_reach ? gather_probability(vertex) : 0.0f;
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

// Clang 14 has no deduction guides for aggregates.
template <class Gather>
GatherVisitor(PathVisitor, Gather) -> GatherVisitor<Gather>;

}  // namespace lanthorn
