// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "path/light_pass.h"
#include "path/path_draw.h"
#include "photon/photon.h"

namespace lanthorn {

/// Which photons a pass stores.
struct PhotonRule {
  int first_depth = 2;  ///< 1 stores photons that come straight from a light, 2 leaves direct light to others
  int max_depth = 64;   ///< of the whole path: a photon at depth k and its use scatter k times
  int roulette_depth = 1;
  bool caustics_alone = false;  ///< ends paths where their next photon could be no caustic's
};

/// Traces the photons of a pass and keeps them in path order: chunk by chunk, each photon's hits one after the other,
/// whatever the number of threads. Reuses its memory from pass to pass.
class PhotonTracer {
 public:
  /// All photons of the pass share `draw`: its time and wavelengths.
  void trace(const Scene& scene, const LightPass& pass, const PhotonRule& rule, const PathDraw& draw) {
    const LightPaths paths(scene, pass);
    emitted_ = paths.total();
    const std::size_t chunks = (emitted_ + light_path_chunk - 1) / light_path_chunk;
    photons_.resize(chunks);
    std::vector<RayCounts> counts(chunks);
    parallel_chunks(emitted_, light_path_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
      std::vector<Photon>& photons = photons_[c];
      photons.clear();
      paths.for_each_in(begin, end, [&](const LightPath& path, Sampler& sampler) {
        walk_from_light(scene, path, draw.time, {rule.max_depth - 1, rule.roulette_depth}, draw.w, sampler, counts[c],
                        StoreVisitor{rule, is_delta(path.light), photons});
      });
    });
    rays_ = {};
    stored_ = 0;
    for (std::size_t c = 0; c < chunks; ++c) {
      rays_ += counts[c];
      stored_ += photons_[c].size();
    }
  }

  std::span<const std::vector<Photon>> chunks() const { return photons_; }
  std::uint64_t emitted() const { return emitted_; }
  std::uint64_t stored() const { return stored_; }
  const RayCounts& rays() const { return rays_; }

 private:
  struct StoreVisitor {
    const PhotonRule& rule;
    bool from_delta_light;
    std::vector<Photon>& photons;

    Continuation operator()(const SurfaceVertex& vertex) const {
      const WalkState& state = vertex.state;
      const bool is_caustic = state.depth > 1 && state.non_delta == 0;
      if ((rule.caustics_alone ? is_caustic : state.depth >= rule.first_depth) && has_non_delta(vertex.at.bsdf))
        photons.push_back({state.beta,
                           vertex.at.position,
                           vertex.wi,
                           vertex.at.normal,
                           {.eye_scatterings = rule.max_depth - state.depth,
                            .caustic = is_caustic,
                            .dispersed = state.dispersed,
                            .from_delta_light = from_delta_light,
                            .direct = state.depth == 1}});
      if (!rule.caustics_alone) return Continuation::go_on();
      const bool may_be_caustic = state.non_delta == 0 && lobe_weights(vertex.at.bsdf, vertex.wi_local).delta > 0;
      return may_be_caustic ? Continuation::go_on() : Continuation::stop();
    }
    Continuation operator()(const MediumVertex&) const { return Continuation::go_on(); }
    void operator()(const EscapeVertex&) const {}
  };

  std::vector<std::vector<Photon>> photons_;
  std::uint64_t emitted_ = 0;
  std::uint64_t stored_ = 0;
  RayCounts rays_;
};

}  // namespace lanthorn
