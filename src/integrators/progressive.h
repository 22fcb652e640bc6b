// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The common parts of the progressive photon mappers: the photon map of a pass, and the eye paths that gather from it.
// The methods differ in the radius of a gather and in the random numbers of an eye path.
#pragma once

#include "base/pool.h"
#include "index/hash_grid.h"
#include "integrators/integrator.h"
#include "path/path_draw.h"
#include "path/path_visitor.h"
#include "photon/gather/kernels.h"
#include "photon/gather/photon_gather.h"
#include "photon/gather/pilot_radius.h"
#include "photon/gather/radius_schedule.h"
#include "photon/guides/emission_choice.h"
#include "photon/media/volume_radius.h"
#include "photon/media/volume_walk.h"
#include "photon/photon_map.h"
#include "photon/photon_pass.h"

namespace lanthorn {

inline ParameterInfo kernel_info() {
  return {"kernel", "epanechnikov", "density estimation kernel: box, cone, epanechnikov, gaussian"};
}
/// Reads the parameter "kernel".
Kernel kernel_parameter(const Parameters& parameters);

/// The parameters of photons in media.
inline std::vector<ParameterInfo> with_volume_parameters(std::vector<ParameterInfo> own) {
  own.insert(own.end(), {volume_info(), volume_radius_info()});
  return own;
}

/// The layers of path classes, and the bias.
FilmContents progressive_layers(const Scene& scene);

/// Message about light of the scene that photon methods with this estimator do not find. Empty if they find all light.
std::string photon_limitation(const Scene& scene, VolumeEstimator estimator);

/// The photons of a pass or of one of its blocks, with the data that the eye paths of the pass share.
struct PassPhotons {
  PassDraw draw;
  std::vector<PhotonMap<HashGrid>> maps;  ///< by class (`FluxClasses`)
  std::optional<VolumeGather> volume;     ///< none if there are no photons in media
  PassReport report;                      ///< report on the photons' part of the pass
  bool are_first = true;                  ///< this is the first block of the pass

  /// The sum of `gather(map, flux_class)` over the classes of photons.
  template <class Gather>
  GatheredLight gather(Gather&& gather) const {
    GatheredLight sum;
    for (std::size_t c = 0; c < maps.size(); ++c) sum += gather(maps[c], static_cast<int>(c));
    return sum;
  }
};

/// Traces the photons of each pass. Reuses its memory from pass to pass.
class PassPhotonSource {
 public:
  explicit PassPhotonSource(const Parameters& parameters)
      : choice_(emission_choice(parameters)),
        estimator_(volume_estimator(parameters)),
        given_volume_radius_(volume_radius_parameter(parameters)),
        volume_schedule_{1, parameters.number("alpha", 1e-3, 1)},
        kernel_(kernel_parameter(parameters)) {}

  /// Chooses the emission guide, and the first radius in media. Call it before the first radius is measured, which
  /// depends on the guide.
  void prepare(const RenderJob& job);
  const Emission& emission() const { return emission_; }
  VolumeEstimator volume() const { return estimator_; }
  /// Traces the photons and builds the maps of their classes for gathers of `support` metres or less, times the radius
  /// factor of the class. At the end it announces the phase of eye paths.
  PassPhotons trace(const RenderJob& job, std::uint32_t pass, const FluxClasses& classes, float support,
                    const PhaseObserver& begin, const LightPathBlock& block = {});

 private:
  EmissionChoice choice_;
  VolumeEstimator estimator_;
  std::optional<float> given_volume_radius_;  ///< m
  RadiusSchedule volume_schedule_;            ///< its first radius is found by `prepare`
  Kernel kernel_;
  Emission emission_;
  Pool<PhotonTracer> tracers_;
};

/// The eye path. At each vertex, next-event estimation finds direct light. Photons provide the indirect light of wide
/// lobes, and the walk continues for the light of narrow lobes, direction by direction (`LobeSplit`).
///
/// `gather(vertex, split)` returns the GatheredLight.
template <class Gather>
struct GatherVisitor : PathVisitor {
  Gather gather;
  bool adds_all = true;  ///< false: the light of photons alone, along the same eye path

  // Without photons in media, the walk continues there like a path tracer's.
  Continuation operator()(const MediumVertex& vertex) {
    if (adds_all) return PathVisitor::operator()(vertex);
    return vertex.may_scatter ? Continuation::go_on() : Continuation::stop();
  }
  void operator()(const MediumRay& ray) {
    if (adds_all) PathVisitor::operator()(ray);
  }
  void operator()(const EmissionVertex& vertex) {
    if (adds_all) PathVisitor::operator()(vertex);
  }
  void operator()(const EscapeVertex& vertex) {
    if (adds_all) PathVisitor::operator()(vertex);
  }
  NarrowContinuation operator()(const SurfaceVertex& vertex) {
    layers.see(vertex);
    if (adds_all) layers.add_hit(vertex, hit_lights(path, vertex));
    if (!vertex.may_scatter) return {Continuation::stop()};
    if (!has_non_delta(vertex.at.bsdf)) return {Continuation::go_on()};

    const LobeSplit split = split_lobes(vertex);
    const NarrowContinuation answer = NarrowContinuation::with_sky_branch(split);
    if (adds_all) add_direct(vertex, answer);
    if (split.is_all_narrow()) return answer;
    add(vertex.state, gather(vertex, split));
    if (adds_all) {
      add_sky(path, vertex, layers);
      add_unlit_emission(path, vertex, split, layers);
    }
    return answer;
  }

 protected:
  void add_direct(const SurfaceVertex& vertex, const NarrowContinuation& answer) {
    path.sampler.seek(visitor_dimensions(vertex.state.depth));
    const DirectLight direct = next_event(path, vertex, answer);
    layers.add(class_of_next_event(vertex.state), direct.radiance, direct.dispersed);
  }
  void add(const WalkState& state, const GatheredLight& light) {
    layers.add(state.non_delta == 0 ? PathClass::caustic : PathClass::indirect, light.caustic, false);
    layers.add(PathClass::indirect, light.indirect, false);
    layers.add_bias(light.bias, false);
  }
};

// Clang 14 has no deduction guides for aggregates.
template <class Gather>
GatherVisitor(PathVisitor, Gather, bool) -> GatherVisitor<Gather>;

/// The same with photons in media.
template <class Gather>
struct VolumeGatherVisitor : GatherVisitor<Gather> {
  VolumeWalk walk;

  void operator()(const FlownSegment& flight) {
    this->layers.see(flight);
    this->add(flight.state, walk.along(this->path, flight));
  }
  void operator()(const MediumRay& ray) { GatherVisitor<Gather>::operator()(ray); }
  void operator()(const EmissionVertex& vertex) {
    if (walk.finds_hits() || !this->path.scene.volume_light(vertex.state.medium))
      GatherVisitor<Gather>::operator()(vertex);
  }
  void operator()(const EscapeVertex& vertex) {
    if (walk.finds_hits()) GatherVisitor<Gather>::operator()(vertex);
  }
  NarrowContinuation operator()(const SurfaceVertex& vertex) {
    if (!walk.is_gathered()) return GatherVisitor<Gather>::operator()(vertex);
    this->layers.see(vertex);
    if (this->adds_all && walk.finds_hits()) this->layers.add_hit(vertex, hit_lights(this->path, vertex));
    return {walk.follow_emission(this->path)};
  }
  Continuation operator()(const MediumVertex& vertex) {
    this->layers.see(vertex);
    if (walk.is_gathered()) return walk.follow_emission(this->path);
    if (!vertex.may_scatter) return Continuation::stop();
    // The decision of the walk comes after the numbers of next-event estimation.
    const MediumLight light = walk.scatter(this->path, vertex, this->ray_light);
    if (this->adds_all)
      this->layers.add(class_of_next_event(vertex.state), light.direct.radiance, light.direct.dispersed);
    this->add(vertex.state, light.gathered);
    return Continuation::go_on();
  }
};
template <class Gather>
VolumeGatherVisitor(GatherVisitor<Gather>, VolumeWalk) -> VolumeGatherVisitor<Gather>;

/// Calls `follow(visitor)` with the visitor of an eye path for these photons, so that scenes without media have no
/// overhead.
template <class Gather, class Follow>
void with_gather_visitor(const PassPhotons& photons, const PathVisitor& base, const Gather& gather, Follow&& follow) {
  const GatherVisitor<Gather> visitor{base, gather, photons.are_first};
  if (photons.volume)
    follow(VolumeGatherVisitor{visitor, VolumeWalk(*photons.volume)});
  else
    follow(visitor);
}

}  // namespace lanthorn
