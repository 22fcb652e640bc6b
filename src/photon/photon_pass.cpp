// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/photon_pass.h"

#include "path/walk.h"

namespace lanthorn {

namespace {

struct StoreVisitor {
  const PhotonRule& rule;
  const LightPath& start;
  float paths;  ///< of the pass
  const Wavelengths& w;
  PhotonChunks& chunks;  ///< where photons are stored
  std::size_t chunk;

  Continuation operator()(const SurfaceVertex& vertex) const {
    const WalkState& state = vertex.state;
    const bool is_caustic = state.depth > 1 && state.non_delta == 0;
    if ((rule.caustics_alone ? is_caustic : state.depth >= rule.first_depth) && has_non_delta(vertex.at.bsdf))
      chunks[static_cast<std::size_t>(rule.classes.of(flux_of(state.beta, state.dispersed, w) * paths))][chunk]
          .push_back({state.beta,
                      vertex.at.position,
                      vertex.wi,
                      vertex.at.normal,
                      {.eye_scatterings = rule.max_depth - state.depth,
                       .caustic = is_caustic,
                       .dispersed = state.dispersed,
                       .from_delta_light = is_delta(start.light),
                       .direct = state.depth == 1}});
    if (!rule.caustics_alone) return Continuation::go_on();
    const bool may_be_caustic = state.non_delta == 0 && lobe_weights(vertex.at.bsdf, vertex.wi_local).delta > 0;
    return may_be_caustic ? Continuation::go_on() : Continuation::stop();
  }
  Continuation operator()(const MediumVertex&) const { return Continuation::go_on(); }
  void operator()(const EscapeVertex&) const {}
};

}  // namespace

void PhotonTracer::trace(const Scene& scene, const LightPass& pass, const PhotonRule& rule, const PassDraw& draw) {
  const LightPaths paths(scene, pass);
  emitted_ = paths.total();
  photons_.resize(static_cast<std::size_t>(rule.classes.count()));
  for (auto& of_class : photons_) {
    of_class.resize(paths.chunk_count());
    for (std::vector<Photon>& photons : of_class) photons.clear();
  }
  const WalkLimits limits{rule.max_depth - 1, rule.roulette_depth};
  rays_ = paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t chunk) {
    walk_from_light(PathContext{scene, draw.w, sampler, counts, limits}, start, draw.of_path(sampler).time,
                    StoreVisitor{rule, start, static_cast<float>(emitted_), draw.w, photons_, chunk});
  });
  stored_ = 0;
  for (const auto& of_class : photons_)
    for (const std::vector<Photon>& photons : of_class) stored_ += photons.size();
}

}  // namespace lanthorn
