// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/reverse_photons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <variant>

#include "base/parallel.h"
#include "photon/incidence.h"
#include "surface/bsdf.h"

namespace lanthorn {

void ReversePhotons::add(const SurfaceVertex& vertex, const LobeSplit& split, Term term) {
  const SurfacePoint& at = vertex.at;
  const WalkState& state = vertex.state;
  const Spectrum* reflectance = lambertian_reflectance(at.bsdf);
  if (reflectance == nullptr || at.is_hair || state.dispersed) {
    others.push_back({state, at, vertex.wi, vertex.wi_local, {split}, term});
    return;
  }
  const Spectrum throughput = state.beta * *reflectance * inv_pi;
  if (throughput.is_black() || vertex.wi_local.z == 0) return;
  diffuse.push_back({throughput, at.position, at.normal, vertex.wi_local.z < 0 ? -at.shading.n : at.shading.n,
                     state.depth - 1, term});
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

// A SIMD vector of floats (vector extension of GCC and Clang).
#ifdef __AVX__
constexpr std::size_t lanes = 8;
#else
constexpr std::size_t lanes = 4;
#endif
using Lanes = float __attribute__((vector_size(lanes * sizeof(float))));
struct LaneVec {
  Lanes x, y, z;
};

Lanes dot(const Vec3& a, const LaneVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Lanes dot(const LaneVec& a, const LaneVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Lanes absolute(const Lanes& v) { return v < 0 ? -v : v; }
// comes_from_behind (photon_hit.h) in lanes.
auto are_from_behind(const Lanes& height, const Lanes& cosine, float flight, float reach) {
  const float in_plane = plane_flatness * reach;
  const Lanes lit_height = cosine > 0 ? height : -height;
  return (lit_height < -in_plane) & (lit_height + flight * absolute(cosine) <= in_plane);
}
template <KernelShape shape>
Lanes profile_of(const Kernel& any, Lanes u) {
  const Kernel kernel{shape, any.cone_slope};  // a compile-time shape, for vector instructions
  for (unsigned i = 0; i < lanes; ++i) u[i] = kernel.profile(u[i]);
  return u;
}

/// Up to `lanes` points of a leaf in SIMD lanes, with their irradiance. Unused lanes repeat the last point.
class DiffuseBundle {
 public:
  explicit DiffuseBundle(std::span<DiffuseReversePhoton* const> records) : records_(records) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const DiffuseReversePhoton& r = *records[std::min(i, records.size() - 1)];
      position_.x[i] = r.position.x, position_.y[i] = r.position.y, position_.z[i] = r.position.z;
      normal_.x[i] = r.normal.x, normal_.y[i] = r.normal.y, normal_.z[i] = r.normal.z;
      eye_normal_.x[i] = r.eye_normal.x, eye_normal_.y[i] = r.eye_normal.y, eye_normal_.z[i] = r.eye_normal.z;
      scatterings_[i] = static_cast<float>(r.scatterings);
    }
  }

  /// `reflected_light` with f = 1; 0 in lanes to whose surface the photon does not belong.
  template <KernelShape shape>
  void add(const InfluencePhoton& photon, const Wavelengths& w, const Kernel& kernel) {
    const Direction wo = photon.incident;
    const Normal own = photon.surface_normal;
    const float support2 = sqr(photon.radius), inverse2 = 1 / support2;
    const LaneVec offset{photon.place.x - position_.x, photon.place.y - position_.y, photon.place.z - position_.z};
    const Lanes dist2 = dot(offset, offset), height = dot(offset, normal_);
    const Lanes cosine = dot(wo, eye_normal_), incidence = dot(wo, normal_), geometric = absolute(incidence);
    const float least_cosine = own == Normal(0) ? 0.0f : one_surface_cosine;
    const auto counts = (dist2 <= support2) & (absolute(height) <= search_flatness * photon.radius) &
                        (absolute(dot(own, normal_)) >= least_cosine) & (cosine > 0) &
                        ~are_from_behind(height, incidence, photon.last_flight, photon.radius) &
                        (scatterings_ <= static_cast<float>(photon.path_flags.eye_scatterings));
    const Lanes divisor = geometric < grazing_cosine ? Lanes{} + grazing_cosine : geometric;  // incidence_ratio
    const Lanes weight = counts ? profile_of<shape>(kernel, dist2 * inverse2) * cosine / divisor : Lanes{};
    const Spectrum density =
        (photon.path_flags.dispersed ? photon.flux * w.dispersed : photon.flux) * (inv_pi * inverse2);
    for (std::size_t c = 0; c < 4; ++c) irradiance_[c] += weight * density.v[c];
  }

  /// Radiance of the points towards the eye.
  void reflect() const {
    for (std::size_t i = 0; i < records_.size(); ++i)
      records_[i]->light *= Spectrum(irradiance_[0][i], irradiance_[1][i], irradiance_[2][i], irradiance_[3][i]);
  }

 private:
  std::span<DiffuseReversePhoton* const> records_;
  LaneVec position_, normal_, eye_normal_;
  Lanes scatterings_;
  std::array<Lanes, 4> irradiance_{};
};

template <KernelShape shape>
void distribute_to_diffuse(const InfluencePhotons& photons, const Kernel& kernel, const Wavelengths& w,
                           std::span<ReversePhotons> pixels) {
  const RecordTree tree(pixels, &ReversePhotons::diffuse);
  tree.tree.for_each_leaf_in(photons.reaches, [&](SlotRange range, std::span<const std::uint32_t> numbers) {
    std::span<DiffuseReversePhoton* const> rest = tree.of(range);
    while (!rest.empty()) {
      const auto records = rest.first(std::min(lanes, rest.size()));
      rest = rest.subspan(records.size());
      const Bounds bounds = bounds_of_records(records);
      DiffuseBundle bundle(records);
      for (const std::uint32_t number : numbers)
        if (reaches(photons.reaches[number], bounds)) bundle.add<shape>(photons.photons[number], w, kernel);
      bundle.reflect();
    }
  });
}

void distribute_to_others(const InfluencePhotons& photons, const Kernel& kernel, const Wavelengths& w,
                          std::span<ReversePhotons> pixels) {
  const RecordTree tree(pixels, &ReversePhotons::others);
  tree.tree.for_each_leaf_in(photons.reaches, [&](SlotRange range, std::span<const std::uint32_t> numbers) {
    for (ReversePhoton* r : tree.of(range)) {
      for (const std::uint32_t number : numbers) {
        const Ball& ball = photons.reaches[number];
        const float dist2 = distance_squared(ball.centre, r->at.position), support2 = sqr(ball.radius);
        if (dist2 > support2) continue;
        const std::optional<Spectrum> light =
            reflected_light(photons.photons[number], r->vertex(), ball.radius, w, r->share);
        if (light) r->light += *light * kernel.weight(dist2, support2);
      }
      r->light *= r->state.beta;
    }
  });
}

}  // namespace

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
  distribute_to_others(photons, kernel, w, pixels);
}

}  // namespace lanthorn
