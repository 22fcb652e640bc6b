// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "cache/reverse_photons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <variant>

#include "base/parallel.h"
#include "surface/bsdf.h"

namespace lanthorn {

void ReversePhotons::add(const SurfaceVertex& vertex, float p, Term term) {
  const SurfacePoint& at = vertex.at;
  const WalkState& state = vertex.state;
  const auto* surface = std::get_if<Diffuse>(&at.bsdf);
  if (surface == nullptr || at.is_hair || state.dispersed) {
    others.push_back({state, at, vertex.wi, vertex.wi_local, {p}, term});
    return;
  }
  const Spectrum throughput = state.beta * surface->reflectance * inv_pi;
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
      result.photons[slot] = {photon.power(), photon.position(),                   radii[slot],
                              photon.wi(),    photon.normal().value_or(Normal(0)), photon.flags()};
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

/// The points of a leaf side by side, for one instruction to treat several; unused places are at infinity.
struct DiffuseLeaf {
  using Lanes = std::array<float, BucketKdTree::leaf_size>;
  alignas(64) Lanes x, y, z, normal_x, normal_y, normal_z, eye_x, eye_y, eye_z;
  alignas(64) std::array<int, BucketKdTree::leaf_size> scatterings;
  alignas(64) std::array<Lanes, 4> irradiance{};
  std::size_t lanes = 0;

  explicit DiffuseLeaf(std::span<DiffuseReversePhoton* const> records) {
    lanes = (records.size() + SlotPoints::width - 1) / SlotPoints::width * SlotPoints::width;
    for (std::size_t i = 0; i < lanes; ++i) {
      const DiffuseReversePhoton& r = *records[std::min(i, records.size() - 1)];
      x[i] = i < records.size() ? r.position.x : infinity;
      y[i] = r.position.y, z[i] = r.position.z;
      normal_x[i] = r.normal.x, normal_y[i] = r.normal.y, normal_z[i] = r.normal.z;
      eye_x[i] = r.eye_normal.x, eye_y[i] = r.eye_normal.y, eye_z[i] = r.eye_normal.z;
      scatterings[i] = r.scatterings;
    }
  }

  /// `reflected_light` by a constant f, of all points.
  template <KernelShape shape>
  void add(const InfluencePhoton& photon, const Spectrum& power, const Kernel& any_kernel) {
    const Kernel kernel{shape, any_kernel.historical, any_kernel.cone_slope};
    const float support2 = sqr(photon.radius), inverse2 = 1 / support2, height = search_flatness * photon.radius;
    const Spectrum density = power * (inv_pi * inverse2);
    const float least_cosine = photon.surface_normal == Normal(0) ? -1.0f : one_surface_cosine;
    const Direction wo = photon.incident;
    const int most_scatterings = photon.path_flags.eye_scatterings;
    for (std::size_t i = 0; i < lanes; ++i) {
      const Vec3 offset = photon.place - Point(x[i], y[i], z[i]);
      const Normal normal(normal_x[i], normal_y[i], normal_z[i]);
      const float dist2 = length_squared(offset), cosine = dot(wo, Normal(eye_x[i], eye_y[i], eye_z[i]));
      const float geometric = std::fabs(dot(wo, normal));
      const bool counts = (dist2 <= support2) & (std::fabs(dot(offset, normal)) <= height) &
                          (dot(photon.surface_normal, normal) >= least_cosine) & (cosine > 0) & (geometric > 0) &
                          (scatterings[i] <= most_scatterings);
      const float weight = counts ? kernel.profile(dist2 * inverse2) * cosine / geometric : 0.0f;
      for (std::size_t c = 0; c < 4; ++c) irradiance[c][i] += weight * density.v[c];
    }
  }
};

template <KernelShape shape>
void distribute_to_diffuse(const InfluencePhotons& photons, const Kernel& kernel, const Wavelengths& w,
                           std::span<ReversePhotons> pixels) {
  const RecordTree tree(pixels, &ReversePhotons::diffuse);
  const auto visit = [&](SlotRange range, std::span<const std::uint32_t> numbers) {
    const std::span<DiffuseReversePhoton* const> records = tree.of(range);
    DiffuseLeaf leaf(records);
    const Bounds bounds = bounds_of_records(records);
    for (const std::uint32_t number : numbers) {
      if (!reaches(photons.reaches[number], bounds)) continue;
      const InfluencePhoton& photon = photons.photons[number];
      leaf.add<shape>(photon, photon.path_flags.dispersed ? photon.flux * w.dispersed : photon.flux, kernel);
    }
    for (std::size_t i = 0; i < records.size(); ++i)
      records[i]->light *=
          Spectrum(leaf.irradiance[0][i], leaf.irradiance[1][i], leaf.irradiance[2][i], leaf.irradiance[3][i]);
  };
  tree.tree.for_each_leaf_in(photons.reaches, visit);
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
        const std::optional<Spectrum> light = reflected_light(photons.photons[number], r->vertex(),
                                                              search_flatness * ball.radius, w, r->share);
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
      case KernelShape::gaussian_jensen:
        return distribute_to_diffuse<KernelShape::gaussian_jensen>(photons, kernel, w, pixels);
    }
  };
  to_diffuse();
  distribute_to_others(photons, kernel, w, pixels);
}

}  // namespace lanthorn
