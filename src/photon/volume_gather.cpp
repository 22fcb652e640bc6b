// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/volume_gather.h"

#include <bit>

#include "medium/transmittance_curve.h"

namespace lanthorn {

namespace {

// Adds up photons' light. Power stands for the radiant flux of the photon, wherever it is.
class Sum {
 public:
  Sum(const PathContext& path, const HenyeyGreenstein& phase_function, const Direction& wi, const WalkState& state,
      int eye_scatterings)
      : w_(path.w),
        phase_(phase_function),
        wi_(wi),
        beta_(state.beta),
        dispersed_(state.dispersed),
        eye_scatterings_(eye_scatterings),
        share_(gather_probability(phase_function)) {}

  /// True if a path with this photon is within the depth limit.
  bool reaches(const PhotonFlags& flags) const { return flags.eye_scatterings >= eye_scatterings_; }
  void add(const PhotonFlags& flags, const Direction& to_photon, Spectrum light) {
    light *= phase(phase_, wi_, to_photon);
    if (dispersed_ || flags.dispersed) light *= w_.dispersed;
    if (flags.caustic)
      light_.caustic += light * (flags.from_delta_light ? 1.0f : share_);
    else
      light_.indirect += light * share_;
  }
  GatheredLight result() const { return {beta_ * light_.caustic, beta_ * light_.indirect}; }

 private:
  const Wavelengths& w_;
  const HenyeyGreenstein& phase_;
  Direction wi_;
  Spectrum beta_;
  bool dispersed_;
  int eye_scatterings_;
  float share_;
  GatheredLight light_;
};

// Random numbers that belong to an eye path and a ray of it.
std::uint64_t key_of(const PathContext& path, int depth, const Point& origin, const Direction& direction) {
  HashRng own = path.sampler.generator(visitor_dimensions(depth));
  const auto bits =
      std::uint64_t{std::bit_cast<std::uint32_t>(own.next())} << 32 | std::bit_cast<std::uint32_t>(own.next());
  return hash_vec(direction, hash_vec(origin, bits));
}

// Transmittance from the start of a beam to its point s.
Spectrum along_beam(const PathContext& path, const Medium& medium, const Beam& beam, float s, std::uint64_t key,
                    std::uint32_t slot) {
  HashRng rng(hash_words({key, slot}));
  return transmittance(medium, {beam.origin, beam.direction, s}, path.w, rng);
}

// Photons in a disc across the ray, each at the place where the ray passes it (Jarosz et al. 2008, eq. 14).
void add_points_along(const PathContext& path, const VolumeMap::Points& photons, const Medium& medium,
                      const RaySegment& ray, std::uint64_t key, const KernelIn& kernel, Sum& sum) {
  HashRng rng(key);
  const TransmittanceCurve transmitted(medium, {ray.origin, ray.direction, ray.end}, path.w, rng);
  photons.index().for_each_along(ray, [&](std::uint32_t slot, float t, float dist2) {
    const PhotonFlags flags = photons.flags(slot);
    if (!sum.reaches(flags)) return;
    sum.add(flags, photons.wi(slot), photons.power(slot) * transmitted.to(t) * kernel.weight(dist2));
  });
}

// Beams that pass the ray (Jarosz et al. 2011, eq. 12).
void add_beams_along(const PathContext& path, const VolumeMap::Beams& photons, const Medium& medium,
                     const RaySegment& ray, std::uint64_t key, const KernelIn& kernel, Sum& sum) {
  HashRng rng(key);
  const TransmittanceCurve transmitted(medium, {ray.origin, ray.direction, ray.end}, path.w, rng);
  photons.index().for_each_crossing(ray, [&](std::uint32_t slot, const BeamCrossing& c) {
    const PhotonFlags flags = photons.flags(slot);
    if (!sum.reaches(flags)) return;
    const Beam beam = photons.index().beam(slot);
    const Spectrum scattered = scattering_at(medium, ray.origin + c.t * ray.direction, path.w);
    if (scattered.is_black()) return;
    const Spectrum there = along_beam(path, medium, beam, c.s, key, slot);
    sum.add(flags, -beam.direction,
            photons.power(slot) * there * scattered * transmitted.to(c.t) * (kernel.weight(c.dist2) / c.sin));
  });
}

void add_points_at(const VolumeMap::Points& photons, const Point& p, const Spectrum& scattering, const KernelIn& kernel,
                   Sum& sum) {
  // Photons and the eye's flight have both been scattered by the same coefficient.
  const Spectrum once = map(scattering, [](float sigma) { return sigma > 0 ? 1 / sigma : 0.0f; });
  photons.index().for_each_containing(p, [&](std::uint32_t slot, float dist2) {
    const PhotonFlags flags = photons.flags(slot);
    if (sum.reaches(flags)) sum.add(flags, photons.wi(slot), photons.power(slot) * once * kernel.weight(dist2));
  });
}

void add_beams_at(const PathContext& path, const VolumeMap::Beams& photons, const Medium& medium, const Point& p,
                  std::uint64_t key, const KernelIn& kernel, Sum& sum) {
  photons.index().for_each_around(p, [&](std::uint32_t slot, float s, float dist2) {
    const PhotonFlags flags = photons.flags(slot);
    if (!sum.reaches(flags)) return;
    const Beam beam = photons.index().beam(slot);
    sum.add(flags, -beam.direction,
            photons.power(slot) * along_beam(path, medium, beam, s, key, slot) * kernel.weight(dist2));
  });
}

}  // namespace

VolumeEstimator volume_estimator(const Parameters& parameters) {
  return choice<VolumeEstimator, 5>(parameters, "volume",
                                    {{{"path", VolumeEstimator::path},
                                      {"point", VolumeEstimator::point},
                                      {"beam", VolumeEstimator::beam},
                                      {"photon-beam", VolumeEstimator::photon_beam},
                                      {"beams", VolumeEstimator::beams}}});
}

GatheredLight VolumeGather::along(const PathContext& path, const FlownSegment& flight) const {
  const MediumId id = flight.state.medium;
  const VolumeMap::Points* points = estimator_ == VolumeEstimator::beam ? map_.points(id) : nullptr;
  const VolumeMap::Beams* beams = estimator_ == VolumeEstimator::beams ? map_.beams(id) : nullptr;
  if (points == nullptr && beams == nullptr) return {};
  const Medium& medium = path.scene.medium(id);
  const Segment& way = flight.segment;
  const RaySegment ray{way.origin, way.direction, 0, flight.reach};
  const std::uint64_t key = key_of(path, flight.state.depth, way.origin, way.direction);
  Sum sum(path, phase_of(medium), -way.direction, flight.state, flight.state.depth);
  if (points != nullptr)
    add_points_along(path, *points, medium, ray, key, kernel_, sum);
  else
    add_beams_along(path, *beams, medium, ray, key, kernel_, sum);
  return sum.result();
}

GatheredLight VolumeGather::at(const PathContext& path, const MediumVertex& vertex) const {
  const MediumId id = vertex.state.medium;
  const VolumeMap::Points* points = estimator_ == VolumeEstimator::point ? map_.points(id) : nullptr;
  const VolumeMap::Beams* beams = estimator_ == VolumeEstimator::photon_beam ? map_.beams(id) : nullptr;
  if (points == nullptr && beams == nullptr) return {};
  const Medium& medium = path.scene.medium(id);
  Sum sum(path, vertex.phase, vertex.wi, vertex.state, vertex.state.depth - 1);
  if (points != nullptr)
    add_points_at(*points, vertex.position, scattering_at(medium, vertex.position, path.w), kernel_, sum);
  else
    add_beams_at(path, *beams, medium, vertex.position, key_of(path, vertex.state.depth, vertex.position, vertex.wi),
                 kernel_, sum);
  return sum.result();
}

}  // namespace lanthorn
