// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/volume_gather.h"

#include "medium/passing.h"
#include "photon/volume_estimators.h"

namespace lanthorn {

namespace {

// Adds up the light of the photons of a map.
template <class Map>
class Sum {
 public:
  Sum(const PathContext& path, const Map& map, const HenyeyGreenstein& phase_function, const Direction& wi,
      const WalkState& state, int eye_scatterings)
      : w_(path.w),
        map_(map),
        phase_(phase_function),
        wi_(wi),
        beta_(state.beta),
        dispersed_(state.dispersed),
        eye_scatterings_(eye_scatterings),
        share_(gather_probability(phase_function)) {}

  /// True if a path with this photon is within the depth limit.
  bool wants(std::uint32_t slot) const { return map_.flags(slot).eye_scatterings >= eye_scatterings_; }
  void meet(std::uint32_t slot, const VolumeMeeting& meeting) {
    const PhotonFlags flags = map_.flags(slot);
    Spectrum light = map_.power(slot) * meeting.factor * phase(phase_, wi_, map_.wi(slot));
    if (dispersed_ || flags.dispersed) light *= w_.dispersed;
    if (flags.caustic)
      light_.caustic += light * (flags.from_delta_light ? 1.0f : share_);
    else
      light_.indirect += light * share_;
  }
  GatheredLight result() const { return {beta_ * light_.caustic, beta_ * light_.indirect}; }

 private:
  const Wavelengths& w_;
  const Map& map_;
  const HenyeyGreenstein& phase_;
  Direction wi_;
  Spectrum beta_;
  bool dispersed_;
  int eye_scatterings_;
  float share_;
  GatheredLight light_;
};

}  // namespace

VolumeEstimator volume_estimator(const Parameters& parameters) {
  return choice<VolumeEstimator, volume_estimator_count>(parameters, "volume",
                                                         {{{"path", VolumeEstimator::path},
                                                           {"point", VolumeEstimator::point},
                                                           {"beam", VolumeEstimator::beam},
                                                           {"photon-beam", VolumeEstimator::photon_beam},
                                                           {"beams", VolumeEstimator::beams},
                                                           {"short-photon-beam", VolumeEstimator::short_photon_beam},
                                                           {"short-beams", VolumeEstimator::short_beams}}});
}

Spectrum VolumeGather::left(const PathContext& path, const Medium& medium, const VolumeMap::Beams& beams,
                            std::uint32_t slot, float s, std::uint64_t key) const {
  if (are_short_)
    if (const auto weight = passing_weight(medium, s, beams.power(slot), path.w)) return *weight;
  return along_beam(path, medium, beams.index().beam(slot), s, key, slot);
}

GatheredLight VolumeGather::along(const PathContext& path, const FlownSegment& flight) const {
  if (is_at_point(estimator_)) return {};
  const VolumeMap::Points* points = map_.points(flight.state.medium);
  const VolumeMap::Beams* beams = map_.beams(flight.state.medium);
  if (points == nullptr && beams == nullptr) return {};
  const EyeRay eye(path, flight);
  const auto sum = [&](const auto& map) {
    return Sum(path, map, phase_of(eye.medium), -eye.ray.direction, flight.state, flight.state.depth);
  };
  if (points != nullptr) {
    auto light = sum(*points);
    meet_points_along(eye, points->index(), kernel_, light);
    return light.result();
  }
  auto light = sum(*beams);
  meet_beams_along(
      path, eye, beams->index(), kernel_,
      [&](std::uint32_t slot, float s) { return left(path, eye.medium, *beams, slot, s, eye.key); }, light);
  return light.result();
}

GatheredLight VolumeGather::at(const PathContext& path, const MediumVertex& vertex) const {
  if (!is_at_point(estimator_)) return {};
  const VolumeMap::Points* points = map_.points(vertex.state.medium);
  const VolumeMap::Beams* beams = map_.beams(vertex.state.medium);
  if (points == nullptr && beams == nullptr) return {};
  const Medium& medium = path.scene.medium(vertex.state.medium);
  const auto sum = [&](const auto& map) {
    return Sum(path, map, vertex.phase, vertex.wi, vertex.state, vertex.state.depth - 1);
  };
  if (points != nullptr) {
    auto light = sum(*points);
    meet_points_at(points->index(), vertex.position, scattering_at(medium, vertex.position, path.w), kernel_, light);
    return light.result();
  }
  const std::uint64_t key = key_of_ray(path, vertex.state.depth, vertex.position, vertex.wi);
  auto light = sum(*beams);
  meet_beams_at(
      beams->index(), vertex.position, kernel_,
      [&](std::uint32_t slot, float s) { return left(path, medium, *beams, slot, s, key); }, light);
  return light.result();
}

}  // namespace lanthorn
