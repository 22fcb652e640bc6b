// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/media/volume_gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "medium/medium.h"
#include "path/depth.h"
#include "photon/media/volume_estimators.h"

namespace lanthorn {

namespace {

// Passes on the light of each photon of a map, without the kernel and the walk's beta: `take(light, is_caustic,
// meeting)`.
template <class Map, class Take>
class PhotonLight {
 public:
  PhotonLight(const PathContext& path, const Map& map, const HenyeyGreenstein& phase_function, const Direction& wi,
              const WalkState& state, int eye_scatterings, Take& take)
      : w_(path.w),
        map_(map),
        phase_(phase_function),
        wi_(wi),
        dispersed_(state.dispersed),
        eye_scatterings_(eye_scatterings),
        share_(gather_probability(phase_function)),
        take_(take) {}

  /// True if a path with this photon is within the depth limit.
  bool wants(std::uint32_t slot) const { return map_.flags(slot).eye_scatterings >= eye_scatterings_; }
  void meet(std::uint32_t slot, const VolumeMeeting& meeting) const {
    const PhotonFlags flags = map_.flags(slot);
    Spectrum light = map_.power(slot) * meeting.factor * phase(phase_, wi_, map_.wi(slot));
    if (dispersed_ || flags.dispersed) light *= w_.dispersed;
    if (!(flags.caustic && flags.from_delta_light)) light *= share_;
    take_(light, flags.caustic, meeting);
  }

 private:
  const Wavelengths& w_;
  const Map& map_;
  const HenyeyGreenstein& phase_;
  Direction wi_;
  bool dispersed_;
  int eye_scatterings_;
  float share_;
  Take& take_;
};

// Adds up an estimate.
struct GatherWith {
  const KernelIn& kernel;
  GatheredLight sum;

  void operator()(const Spectrum& light, bool is_caustic, const VolumeMeeting& meeting) {
    const Spectrum found = light * kernel.weight(meeting.dist2);
    (is_caustic ? sum.caustic : sum.indirect) += found;
    sum.bias += found * kernel.bias_share(meeting.dist2);
  }
  GatheredLight times(const Spectrum& beta) const { return {beta * sum.caustic, beta * sum.indirect, beta * sum.bias}; }
};

// Adds up estimates with several kernels.
struct CompareKernels {
  const KernelLadder& ladder;
  Spectrum beta;
  float flown;  // from the eye to where meetings count from, m
  std::span<float> sums;
  std::size_t found = 0;

  void operator()(const Spectrum& light, bool, const VolumeMeeting& meeting) {
    ++found;
    const float away2 = sqr(flown + meeting.t);
    const float seen = sum_of(beta * light) * (away2 / (away2 + sqr(ladder.near)));
    const std::span<const KernelIn> kernels = ladder.kernels;
    for (std::size_t k = 0; k < kernels.size() && meeting.dist2 <= sqr(kernels[k].support()); ++k)
      sums[k] += seen * kernels[k].weight(meeting.dist2);
  }
};

constexpr std::array<std::pair<const char*, VolumeEstimator>, volume_estimator_count> estimator_names{
    {{"path", VolumeEstimator::path},
     {"point", VolumeEstimator::point},
     {"beam", VolumeEstimator::beam},
     {"photon-beam", VolumeEstimator::photon_beam},
     {"beams", VolumeEstimator::beams},
     {"short-photon-beam", VolumeEstimator::short_photon_beam},
     {"short-beams", VolumeEstimator::short_beams}}};

}  // namespace

VolumeEstimator volume_estimator(const Parameters& parameters) {
  return choice<VolumeEstimator, volume_estimator_count>(parameters, "volume", estimator_names);
}

std::vector<VolumeEstimator> volume_estimators(const Parameters& parameters, std::span<const VolumeEstimator> known) {
  const std::string& text = parameters.text("volume");
  if (text == "path") return {};
  std::vector<VolumeEstimator> chosen;
  std::vector<std::string> names;
  std::istringstream words(text + '+');
  for (const auto& [name, estimator] : estimator_names)
    if (std::find(known.begin(), known.end(), estimator) != known.end()) names.emplace_back(name);
  for (std::string word; std::getline(words, word, '+');) {
    const auto named = std::find_if(estimator_names.begin(), estimator_names.end(),
                                    [&](const auto& entry) { return entry.first == word; });
    if (named == estimator_names.end() || std::find(known.begin(), known.end(), named->second) == known.end())
      throw Error(fmt::format("--set volume={}: expected path, or one or more of {}, joined by +{}", text,
                              fmt::join(names, ", "), did_you_mean(word, names)));
    chosen.push_back(named->second);
  }
  return chosen;
}

Spectrum VolumeGather::left(const PathContext& path, const Medium& medium, const VolumeMap::Beams& beams,
                            std::uint32_t slot, float s, std::uint64_t key) const {
  if (are_short_)
    if (const auto weight = passing_weight(medium, s, beams.power(slot), path.w)) return *weight;
  return along_beam(path, medium, beams.index().beam(slot), s, key, slot);
}

template <class Take>
void VolumeGather::for_each_along(const PathContext& path, const FlownSegment& flight, Take&& take) const {
  if (is_at_point(estimator_)) return;
  const VolumeMap::Points* points = map_.points(flight.state.medium);
  const VolumeMap::Beams* beams = map_.beams(flight.state.medium);
  if (points == nullptr && beams == nullptr) return;
  const EyeRay eye(path, flight);
  const auto visitor = [&](const auto& map) {
    return PhotonLight(path, map, phase_of(eye.medium), -eye.ray.direction, flight.state,
                       scatterings_on_flight(path.scene, flight.state) - 1, take);
  };
  if (points != nullptr) return meet_points_along(eye, points->index(), kernel_.support(), visitor(*points));
  meet_beams_along(
      path, eye, beams->index(),
      [&](std::uint32_t slot, float s) { return left(path, eye.medium, *beams, slot, s, eye.key); }, visitor(*beams));
}

template <class Take>
void VolumeGather::for_each_at(const PathContext& path, const MediumVertex& vertex, Take&& take) const {
  if (!is_at_point(estimator_)) return;
  const VolumeMap::Points* points = map_.points(vertex.state.medium);
  const VolumeMap::Beams* beams = map_.beams(vertex.state.medium);
  if (points == nullptr && beams == nullptr) return;
  const Medium& medium = path.scene.medium(vertex.state.medium);
  const auto visitor = [&](const auto& map) {
    return PhotonLight(path, map, vertex.phase, vertex.wi, vertex.state, vertex.state.scatterings() - 1, take);
  };
  if (points != nullptr)
    return meet_points_at(points->index(), vertex.position, scattering_at(medium, vertex.position, path.w),
                          visitor(*points));
  const std::uint64_t key = key_of_ray(path, vertex.state.depth, vertex.position, vertex.wi);
  meet_beams_at(
      beams->index(), vertex.position,
      [&](std::uint32_t slot, float s) { return left(path, medium, *beams, slot, s, key); }, visitor(*beams));
}

GatheredLight VolumeGather::along(const PathContext& path, const FlownSegment& flight) const {
  GatherWith gather{kernel_, {}};
  for_each_along(path, flight, gather);
  return gather.times(flight.state.beta);
}

GatheredLight VolumeGather::at(const PathContext& path, const MediumVertex& vertex) const {
  GatherWith gather{kernel_, {}};
  for_each_at(path, vertex, gather);
  return gather.times(vertex.state.beta);
}

std::size_t VolumeGather::compare_along(const PathContext& path, const FlownSegment& flight, float flown,
                                        const KernelLadder& ladder, std::span<float> sums) const {
  CompareKernels compare{ladder, flight.state.beta, flown, sums};
  for_each_along(path, flight, compare);
  return compare.found;
}

std::size_t VolumeGather::compare_at(const PathContext& path, const MediumVertex& vertex, float flown,
                                     const KernelLadder& ladder, std::span<float> sums) const {
  CompareKernels compare{ladder, vertex.state.beta, flown, sums};
  for_each_at(path, vertex, compare);
  return compare.found;
}

}  // namespace lanthorn
