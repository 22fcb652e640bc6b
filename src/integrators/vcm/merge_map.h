// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The photons of a pass on surfaces, with the data that MIS weights need, for merging with eye vertices.
#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "index/hash_grid.h"
#include "integrators/vcm/merge_radii.h"
#include "path/light_vertices.h"
#include "path/path_class.h"
#include "photon/gather/photon_hit.h"
#include "photon/incidence.h"

namespace lanthorn {

/// A photon to be merged. The index stores its position.
struct MergePhoton {
  Spectrum power;  ///< watts, over the light paths of the pass, times grazing_gain
  Direction wi{0, 0, 1};
  float distance = 0;  ///< to the vertex before, m
  VertexDensities densities;
  std::uint16_t scatterings = 0;  ///< as in WalkState
  bool direct : 1 = false;        ///< straight from the light
  bool caustic : 1 = false;
  bool dispersed : 1 = false;
};

/// A MergePhoton with its position and the interface of `PhotonMap::Ref`.
struct PlacedMergePhoton {
  const MergePhoton& photon;
  Point place;
  int max_depth;  ///< of paths

  Point position() const { return place; }
  Direction wi() const { return photon.wi; }
  float flight() const { return photon.distance; }
  PhotonFlags flags() const {
    return {
        .eye_scatterings = max_depth - photon.scatterings, .caustic = photon.caustic, .dispersed = photon.dispersed};
  }
};

/// Class of the light that a photon brings to an eye path in that state. `direct`: the photon comes straight from the
/// light; `caustic`: it has met delta lobes only.
inline PathClass class_of_merge(const WalkState& state, bool direct, bool caustic) {
  if (state.non_delta > 0) return PathClass::indirect;
  if (direct) return PathClass::direct;
  return caustic ? PathClass::caustic : PathClass::indirect;
}

/// The vertices of light paths at which photons of one class are merged, sorted for queries of a largest radius.
class MergeMap {
 public:
  /// Stores the vertices of depth `least_depth` or more.
  MergeMap(const LightVertices& vertices, int least_depth, float radius, int flux_class) {
    const std::vector<const LightVertex*> merged = vertices.select([&](const LightVertex& v) {
      return !v.phase && v.flux_class == flux_class && v.depth >= least_depth && merges_at(v.at);
    });
    std::vector<Point> positions(merged.size());
    parallel_chunks(merged.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) positions[i] = merged[i]->at.position;
    });
    IndexBuild<HashGrid> built = HashGrid::build(positions, radius);
    grid_ = std::move(built.index);
    photons_.resize(merged.size());
    parallel_chunks(merged.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot) {
        const LightVertex& v = *merged[built.order[slot]];
        const Spectrum power = v.beta * grazing_gain(geometric_cosine(v.at, v.wi));
        photons_[slot] = {power,        v.wi,      v.distance, v.densities, static_cast<std::uint16_t>(v.scatterings),
                          v.depth == 1, v.caustic, v.dispersed};
      }
    });
  }

  /// Calls `visit(const MergePhoton&, Point, float dist2)` for every photon within `radius`, in a fixed order.
  template <class Visit>
  void for_each_near(const Point& p, float radius, Visit&& visit) const {
    grid_.for_each_near(p, radius,
                        [&](std::uint32_t slot, float dist2) { visit(photons_[slot], grid_.position(slot), dist2); });
  }
  std::size_t size() const { return photons_.size(); }
  std::size_t memory_bytes() const { return grid_.memory_bytes() + std::span(photons_).size_bytes(); }

 private:
  static constexpr std::size_t chunk = 1u << 13;

  HashGrid grid_;
  std::vector<MergePhoton> photons_;
};

/// Where a photon lies in the disc of a merge.
struct PlaceInDisc {
  Vec3 offset;    ///< from the centre, m
  float u;        ///< squared distance over that of the edge
  float density;  ///< of the kernel, 1/m²
};

/// The photons that a pass merges on surfaces: one map for each class of flux, since discs grow with the flux.
class SurfaceMerges {
 public:
  SurfaceMerges(const LightVertices& vertices, int least_depth, const MergeRadii& radii) : radii_(radii) {
    for (int c = 0; c < radii.classes().count(); ++c)
      maps_.emplace_back(vertices, least_depth, merge_kernel.support(radii.largest(c)), c);
  }

  /// Calls `visit(photon, hit, place)` for each photon that meets the vertex of an eye path through `raster`, in a path
  /// of at most `max_depth` scatterings. `place`: see PlaceInDisc.
  template <class Visit>
  void for_each_at(const GatherVertex& gather, const Vec2& raster, int max_depth, Visit&& visit) const {
    const Point& at = gather.vertex().at.position;
    for (std::size_t c = 0; c < maps_.size(); ++c) {
      const float support = merge_kernel.support(radii_.at(raster, static_cast<int>(c))), support2 = support * support;
      maps_[c].for_each_near(at, support, [&](const MergePhoton& photon, const Point& p, float dist2) {
        const auto hit = gather.meet<true>(PlacedMergePhoton{photon, p, max_depth}, support);
        if (hit) visit(photon, *hit, PlaceInDisc{p - at, dist2 / support2, merge_kernel.weight(dist2, support2)});
      });
    }
  }
  std::size_t size() const {
    return std::accumulate(maps_.begin(), maps_.end(), std::size_t{0},
                           [](std::size_t sum, const MergeMap& map) { return sum + map.size(); });
  }
  std::size_t memory_bytes() const {
    return std::accumulate(maps_.begin(), maps_.end(), std::size_t{0},
                           [](std::size_t sum, const MergeMap& map) { return sum + map.memory_bytes(); });
  }

 private:
  MergeRadii radii_;
  std::vector<MergeMap> maps_;  // by class
};

}  // namespace lanthorn
