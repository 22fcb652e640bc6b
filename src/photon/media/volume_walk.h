// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "path/direct_light.h"
#include "path/walk.h"
#include "photon/media/volume_gather.h"

namespace lanthorn {

/// An eye walk's light at a vertex in a medium.
struct MediumLight {
  DirectLight direct;      ///< single scattering, by next-event estimation; the walk's next ray finds the rest
  GatheredLight gathered;  ///< by estimators at points
};

/// Divides the light of media between an eye walk and photons. Where the walk scatters in a medium, next-event
/// estimation and the walk's next ray find single scattering, combined by MIS. Photons give the share p of all other
/// light (`gather_probability`), along each flight's whole way or at the point of scattering. With probability 1 - p
/// the walk continues for the rest. Otherwise it is *gathered*: its next ray still finds lights, and after that it
/// finds only the emission of media that are not lights.
class VolumeWalk {
 public:
  explicit VolumeWalk(const VolumeGather& volume) : volume_(&volume) {}

  bool is_gathered() const { return is_gathered_; }
  /// False once the walk must not add light of emitters that it hits.
  bool finds_hits() const { return !hits_are_known_; }

  /// Light of photons along a flight.
  GatheredLight along(const PathContext& path, const FlownSegment& flight) const {
    return is_gathered_ || flight.state.medium == MediumId::vacuum ? GatheredLight{} : volume_->along(path, flight);
  }

  /// Light at a vertex, and the decision whether the walk is gathered from there on. The walk must continue in either
  /// case. Preconditions: it is not gathered, and the vertex may scatter.
  MediumLight scatter(const PathContext& path, const MediumVertex& vertex, const RayLight& ray_light) {
    const bool photons_reach = vertex.state.scatterings() <= PhotonFlags::most_eye_scatterings + 1;
    const float p = photons_reach ? gather_probability(vertex.phase) : 0.0f;
    path.sampler.seek(visitor_dimensions(vertex.state.depth));
    const MediumLight light{ray_light.next_event_at(path, vertex), volume_->at(path, vertex)};
    is_gathered_ = path.sampler.next() < p;
    return light;
  }

  /// The answer of a gathered walk's visitor at a vertex.
  Continuation follow_emission(const PathContext& path) {
    hits_are_known_ = true;
    return path.scene.has_unlit_emission() ? Continuation::go_on() : Continuation::stop();
  }

 private:
  const VolumeGather* volume_;
  bool is_gathered_ = false, hits_are_known_ = false;
};

}  // namespace lanthorn
