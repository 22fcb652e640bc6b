// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/reverse_photons.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/parallel.h"
#include "math/lanes.h"
#include "photon/gather/photon_hit.h"
#include "photon/incidence.h"
#include "surface/bsdf.h"

namespace lanthorn {

void ReversePhotons::add(const SurfaceVertex& vertex, const Wavelengths& w, const LobeSplit& split, Term term) {
  const SurfacePoint& at = vertex.at;
  const WalkState& state = vertex.state;
  const Spectrum* reflectance = lambertian_reflectance(at.bsdf);
  if (reflectance == nullptr || at.is_hair || state.dispersed) {
    others.push_back({state, at, vertex.wi, vertex.wi_local, {split}, term, w});
    return;
  }
  const Spectrum throughput = state.beta * *reflectance * inv_pi;
  if (throughput.is_black()) return;
  const float side = dot(vertex.wi, at.normal) < 0 ? -1.0f : 1.0f;
  diffuse.push_back({throughput, at.position, side * at.normal, side * at.shading.n, state.scatterings() - 1, term});
}

InfluencePhotons InfluencePhotons::of(const PhotonMap<BucketKdTree>& map, std::span<const float> radii) {
  InfluencePhotons result;
  result.photons.resize(map.size());
  result.reaches.resize(map.size());
  constexpr std::size_t chunk = 1u << 13;
  parallel_chunks(map.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const auto photon = map[static_cast<std::uint32_t>(slot)];
      result.photons[slot] = {
          photon.power(), photon.position(), radii[slot], photon.wi(), photon.normal().value_or(Normal(0)),
          photon.flags(), photon.flight()};
      result.reaches[slot] = {photon.position(), radii[slot]};
    }
  });
  return result;
}

namespace {

float nearest_radius(const PhotonMap<BucketKdTree>& map, const Point& p, const EstimateSettings& settings) {
  // One more, because the query finds the photon itself.
  std::array<Neighbour, EstimateSettings::most_nearest + 1> memory;
  const std::size_t wanted = std::min(settings.nearest, EstimateSettings::most_nearest) + 1;
  const std::span<const Neighbour> found = map.nearest(p, settings.radius, std::span(memory).first(wanted));
  return found.size() == wanted ? std::sqrt(found.front().dist2) : settings.radius;
}

// Radius from a leaf. For n photons distributed evenly on a square of diagonal d, a disc with k of them has
// π r² = k/n · d²/2. The bounding box of n points is smaller than the square: of n+1 gaps along each side it spans
// n-1.
float leaf_radius(const Bounds& bounds, std::size_t count, const EstimateSettings& settings) {
  if (count < 2) return settings.radius;
  const auto n = static_cast<float>(count);
  const float diagonal2 = length_squared(bounds.extent()) * sqr((n + 1) / (n - 1));
  return std::sqrt(static_cast<float>(settings.nearest) / n * diagonal2 / 2 * inv_pi);
}

const Point& position_of(const DiffuseReversePhoton& r) { return r.position; }
const Point& position_of(const ReversePhoton& r) { return r.at.position; }

/// Records of all pixels in the slot order of a tree.
template <class Record>
struct RecordTree {
  BucketKdTree tree;
  std::vector<Record*> records;

  RecordTree(std::span<ReversePhotons> pixels, std::vector<Record> ReversePhotons::*kind) {
    std::vector<Record*> numbered;
    std::vector<Point> positions;
    for (ReversePhotons& pixel : pixels)
      for (Record& r : pixel.*kind) {
        numbered.push_back(&r);
        positions.push_back(position_of(r));
      }
    IndexBuild<BucketKdTree> built = BucketKdTree::build(positions);
    tree = std::move(built.index);
    records.resize(numbered.size());
    for (std::size_t slot = 0; slot < records.size(); ++slot) records[slot] = numbered[built.order[slot]];
  }
  std::span<Record* const> of(SlotRange range) const {
    return std::span(records).subspan(range.begin, range.end - range.begin);
  }
};

template <class Record>
Bounds bounds_of_records(std::span<Record* const> records) {
  Bounds bounds;
  for (const Record* r : records) bounds.extend(position_of(*r));
  return bounds;
}

bool reaches(const Ball& ball, const Bounds& bounds) {
  const Point nearest = glm::clamp(ball.centre, bounds.min, bounds.max);
  return distance_squared(nearest, ball.centre) <= sqr(safe_reach(ball.radius));
}

template <KernelShape shape>
Lanes profile_of(const Kernel& any, const Lanes& u) {
  const Kernel kernel{shape, any.cone_slope};  // a compile-time shape, for vector instructions
  std::array<float, Lanes::width> values = u.stored();
  for (float& value : values) value = kernel.profile(value);
  return Lanes(values);
}

/// Up to eight points of a leaf in lanes, with their irradiance. Unused lanes repeat the last point.
class DiffuseBundle {
 public:
  explicit DiffuseBundle(std::span<DiffuseReversePhoton* const> records) : records_(records) {
    StoredVec3 position, normal, eye_normal;
    std::array<float, Lanes::width> scatterings;
    for (std::uint32_t i = 0; i < Lanes::width; ++i) {
      const DiffuseReversePhoton& r = *records[std::min<std::size_t>(i, records.size() - 1)];
      position.set(i, r.position);
      normal.set(i, r.normal);
      eye_normal.set(i, r.eye_normal);
      scatterings[i] = static_cast<float>(r.scatterings);
    }
    position_ = position.load();
    normal_ = normal.load();
    eye_normal_ = eye_normal.load();
    scatterings_ = Lanes(scatterings);
  }

  /// `reflected_light` with f = 1; 0 in lanes whose surface the photon does not belong to.
  template <KernelShape shape>
  void add(const InfluencePhoton& photon, const Wavelengths& w, const Kernel& kernel) {
    const LaneVec3 wo = in_lanes(photon.incident), own = in_lanes(photon.surface_normal);
    const float support2 = sqr(photon.radius), inverse2 = 1 / support2;
    const LaneVec3 offset = in_lanes(photon.place) - position_;
    const Lanes dist2 = dot(offset, offset), height = dot(offset, normal_);
    const Lanes cosine = dot(wo, eye_normal_), incidence = dot(wo, normal_);
    const float least_cosine = photon.surface_normal == Normal(0) ? 0.0f : one_surface_cosine;
    const LaneMask counts = (dist2 <= support2) & are_on_surface(height, incidence, photon.last_flight, photon.radius) &
                            (least_cosine <= abs(dot(own, normal_))) & (0.0f < incidence) & (0.0f < cosine) &
                            (scatterings_ <= static_cast<float>(photon.path_flags.eye_scatterings));
    const Lanes divisor = max(incidence, grazing_cosine);  // incidence_ratio
    const Lanes weight = select(counts, profile_of<shape>(kernel, dist2 * inverse2) * cosine / divisor, 0.0f);
    const Spectrum density =
        (photon.path_flags.dispersed ? photon.flux * w.dispersed : photon.flux) * (inv_pi * inverse2);
    for (std::size_t c = 0; c < 4; ++c) irradiance_[c] = irradiance_[c] + weight * density.v[c];
  }

  /// Radiance of the points towards the eye.
  void reflect() const {
    const std::array<std::array<float, Lanes::width>, 4> irradiance{irradiance_[0].stored(), irradiance_[1].stored(),
                                                                    irradiance_[2].stored(), irradiance_[3].stored()};
    for (std::size_t i = 0; i < records_.size(); ++i)
      records_[i]->light *= Spectrum(irradiance[0][i], irradiance[1][i], irradiance[2][i], irradiance[3][i]);
  }

 private:
  static LaneVec3 in_lanes(const Vec3& v) { return {v.x, v.y, v.z}; }

  std::span<DiffuseReversePhoton* const> records_;
  LaneVec3 position_{0, 0, 0}, normal_{0, 0, 0}, eye_normal_{0, 0, 0};
  Lanes scatterings_ = 0;
  std::array<Lanes, 4> irradiance_{0, 0, 0, 0};
};

template <KernelShape shape>
void distribute_to_diffuse(const InfluencePhotons& photons, const Kernel& kernel, const Wavelengths& w,
                           std::span<ReversePhotons> pixels) {
  const RecordTree tree(pixels, &ReversePhotons::diffuse);
  tree.tree.for_each_leaf_in(photons.reaches, [&](SlotRange range, std::span<const std::uint32_t> numbers) {
    std::span<DiffuseReversePhoton* const> rest = tree.of(range);
    while (!rest.empty()) {
      const auto records = rest.first(std::min<std::size_t>(Lanes::width, rest.size()));
      rest = rest.subspan(records.size());
      const Bounds bounds = bounds_of_records(records);
      DiffuseBundle bundle(records);
      for (const std::uint32_t number : numbers)
        if (reaches(photons.reaches[number], bounds)) bundle.add<shape>(photons.photons[number], w, kernel);
      bundle.reflect();
    }
  });
}

void distribute_to_others(const InfluencePhotons& photons, const Kernel& kernel, std::span<ReversePhotons> pixels) {
  const RecordTree tree(pixels, &ReversePhotons::others);
  tree.tree.for_each_leaf_in(photons.reaches, [&](SlotRange range, std::span<const std::uint32_t> numbers) {
    for (ReversePhoton* r : tree.of(range)) {
      const SurfaceVertex vertex = r->vertex();
      const GatherVertex gather(vertex);
      for (const std::uint32_t number : numbers) {
        const Ball& ball = photons.reaches[number];
        const float dist2 = distance_squared(ball.centre, r->at.position), support2 = sqr(ball.radius);
        if (dist2 > support2) continue;
        const std::optional<Spectrum> light =
            reflected_light(photons.photons[number], gather, ball.radius, r->w, r->share);
        if (light) r->light += *light * kernel.weight(dist2, support2);
      }
      r->light *= r->state.beta;
    }
  });
}

}  // namespace

std::vector<float> photon_radii(const PhotonMap<BucketKdTree>& map, const EstimateSettings& settings, RadiusRule rule) {
  std::vector<float> radii(map.size(), settings.kernel.support(settings.radius));
  if (settings.nearest == 0) return radii;
  // A lower bound for coincident photons, whose radius would be 0.
  const auto bounded = [&](float r) { return std::clamp(r, 1e-3f * settings.radius, settings.radius); };
  const BucketKdTree& tree = map.index();
  if (rule == RadiusRule::leaf) {
    tree.for_each_leaf([&](SlotRange range) {
      Bounds bounds;
      for (std::uint32_t slot = range.begin; slot < range.end; ++slot) bounds.extend(tree.position(slot));
      const float radius = leaf_radius(bounds, range.end - range.begin, settings);
      std::fill(radii.begin() + range.begin, radii.begin() + range.end, bounded(radius));
    });
    return radii;
  }
  constexpr std::size_t chunk = 1024;
  parallel_chunks(radii.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot)
      radii[slot] = bounded(nearest_radius(map, tree.position(static_cast<std::uint32_t>(slot)), settings));
  });
  return radii;
}

void distribute(const InfluencePhotons& photons, const Kernel& kernel, const Wavelengths& w,
                std::span<ReversePhotons> pixels) {
  const auto to_diffuse = [&] {
    switch (kernel.shape) {
      case KernelShape::box:
        return distribute_to_diffuse<KernelShape::box>(photons, kernel, w, pixels);
      case KernelShape::cone:
        return distribute_to_diffuse<KernelShape::cone>(photons, kernel, w, pixels);
      case KernelShape::epanechnikov:
        return distribute_to_diffuse<KernelShape::epanechnikov>(photons, kernel, w, pixels);
      case KernelShape::gaussian:
        return distribute_to_diffuse<KernelShape::gaussian>(photons, kernel, w, pixels);
    }
  };
  to_diffuse();
  distribute_to_others(photons, kernel, pixels);
}

}  // namespace lanthorn
