// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/photon_pass.h"

#include <cmath>
#include <utility>

#include "medium/medium.h"
#include "path/depth.h"
#include "path/walk.h"

namespace lanthorn {

namespace {

// Flags of a photon at the walk's vertex of this depth. `scatterings`: as in WalkState. `dispersed`: see LightToMeet.
PhotonFlags flags_of(const WalkState& state, int depth, int scatterings, bool dispersed, const PhotonRule& rule,
                     bool from_delta_light) {
  const bool caustic = depth > 1 && state.non_delta == 0;
  return {.eye_scatterings = rule.max_depth - scatterings,
          .caustic = caustic,
          .dispersed = dispersed,
          .from_delta_light = caustic && from_delta_light,
          .direct = depth == 1};
}

struct StoreVisitor {
  const PhotonRule& rule;
  const LightPath& start;
  float paths;  ///< of the pass
  const Wavelengths& w;
  PhotonChunks& chunks;  ///< where photons are stored
  std::size_t chunk;

  Continuation operator()(const SurfaceVertex& vertex) const {
    const WalkState& state = vertex.state;
    if (state.scatterings() > rule.max_depth) return Continuation::stop();
    const LightToMeet kept = LightToMeet::of(state.beta, state.dispersed, w);
    const PhotonFlags flags =
        flags_of(state, state.depth, state.scatterings(), kept.dispersed, rule, is_delta(start.light));
    if ((rule.caustics_alone ? flags.caustic : state.depth >= rule.first_depth) && has_non_delta(vertex.at.bsdf))
      chunks[static_cast<std::size_t>(rule.classes.of(flux_of(state.beta, state.dispersed, w) * paths))][chunk]
          .push_back({kept.light, vertex.at.position, vertex.wi, vertex.at.normal, flags,
                      std::sqrt(distance_squared(vertex.at.position, state.previous))});
    if (!rule.caustics_alone) return Continuation::go_on();
    const bool may_be_caustic = state.non_delta == 0 && lobe_weights(vertex.at.bsdf, vertex.wi_local).delta > 0;
    return may_be_caustic ? Continuation::go_on() : Continuation::stop();
  }
  Continuation operator()(const MediumVertex&) const { return Continuation::go_on(); }
  void operator()(const EscapeVertex&) const {}
};

// Stores photons in media, too.
struct MediumPointVisitor : StoreVisitor {
  std::vector<MediumPhoton>& in_media;

  using StoreVisitor::operator();
  Continuation operator()(const MediumVertex& vertex) const {
    const WalkState& state = vertex.state;
    if (state.scatterings() > rule.max_depth) return Continuation::stop();
    if (state.depth < rule.first_medium_depth) return Continuation::go_on();
    const LightToMeet kept = LightToMeet::of(state.beta, state.dispersed, w);
    in_media.push_back(
        {{kept.light, vertex.position, vertex.wi, vertex.wi,
          flags_of(state, state.depth, state.scatterings(), kept.dispersed, rule, is_delta(start.light))},
         state.medium});
    return Continuation::go_on();
  }
};

// Stores flights through media.
struct BeamVisitor : StoreVisitor {
  const PathContext& path;
  std::vector<MediumPhoton>& in_media;
  float share;     ///< of the paths whose flights are stored; 0: not those of this one
  bool are_short;  ///< they end where they scatter

  using StoreVisitor::operator();
  void operator()(const FlownSegment& flight) const {
    const WalkState& state = flight.state;
    const int scatterings = scatterings_on_flight(path.scene, state);
    if (share == 0 || state.medium == MediumId::vacuum || state.depth + 1 < rule.first_medium_depth ||
        scatterings > rule.max_depth)
      return;
    const Segment& way = flight.segment;
    const Medium& medium = path.scene.medium(state.medium);
    const float reach = are_short && knows_passing(medium) ? way.length : flight.reach;
    const float length = scattering_length(medium, {way.origin, way.direction, reach}, path.w);
    if (!(length > 0)) return;
    const LightToMeet kept = LightToMeet::of(state.beta / share, state.dispersed, path.w);
    in_media.push_back({{kept.light, way.origin, -way.direction, -way.direction,
                         flags_of(state, state.depth + 1, scatterings, kept.dispersed, rule, is_delta(start.light))},
                        state.medium,
                        length});
  }
};

}  // namespace

void PhotonTracer::trace(const Scene& scene, LightPass pass, const PhotonRule& rule, const PassDraw& draw,
                         const LightGuide* guide) {
  if (guide != nullptr) pass.guide = &guide->emission;
  const LightPaths paths(scene, pass);
  const MediumRecords records = scene.has_scattering_media() ? rule.media : MediumRecords::none;
  emitted_ = paths.count();
  photons_.resize(static_cast<std::size_t>(rule.classes.count()));
  for (auto& of_class : photons_) {
    of_class.resize(paths.chunk_count());
    for (std::vector<Photon>& photons : of_class) photons.clear();
  }
  medium_photons_.resize(records == MediumRecords::none ? 0 : paths.chunk_count());
  for (std::vector<MediumPhoton>& photons : medium_photons_) photons.clear();
  const float beam_share = share_of_beams(paths.total());
  const WalkLimits limits{max_depth_of_photons(scene, rule.max_depth), rule.roulette_depth};
  rays_ = paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t chunk) {
    const PathDraw own = draw.of_path(sampler);
    const PathContext path{scene, own.w, sampler, counts, limits};
    const StoreVisitor store{rule, start, static_cast<float>(paths.total()), own.w, photons_, chunk};
    const auto follow = [&](auto visitor) { walk_from_light(path, start, own.time, std::move(visitor)); };
    switch (records) {
      case MediumRecords::none:
        return with_directions(guide, store, follow);
      case MediumRecords::points:
        return with_directions(guide, MediumPointVisitor{store, medium_photons_[chunk]}, follow);
      case MediumRecords::beams:
      case MediumRecords::short_beams: {
        const bool stores = keeps_beams(sampler, beam_share);
        const BeamVisitor visitor{store, path, medium_photons_[chunk], stores ? beam_share : 0.0f,
                                  records == MediumRecords::short_beams};
        return with_directions(guide, visitor, follow);
      }
    }
  });
  stored_ = stored_in_media_ = 0;
  for (const auto& of_class : photons_)
    for (const std::vector<Photon>& photons : of_class) stored_ += photons.size();
  for (const std::vector<MediumPhoton>& photons : medium_photons_) stored_in_media_ += photons.size();
  stored_ += stored_in_media_;
}

}  // namespace lanthorn
