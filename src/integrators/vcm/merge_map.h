// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons with what merging weights need of them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "index/hash_grid.h"
#include "path/light_vertices.h"
#include "path/path_class.h"
#include "photon/incidence.h"

namespace lanthorn {

/// A photon to be merged; its position is the index's.
struct MergePhoton {
  Spectrum power;  ///< watts, over the light paths of the pass, times grazing_gain
  Direction wi{0, 0, 1};
  float distance = 0;  ///< to the vertex before, m
  VertexDensities densities;
  std::uint16_t depth = 0;
  bool caustic = false;
  bool dispersed = false;
};

/// Of light that comes by way of a photon of this depth to an eye path in that state. `caustic`: the photon has met
/// delta lobes only.
inline PathClass class_of_merge(const WalkState& state, int depth, bool caustic) {
  if (state.non_delta > 0) return PathClass::indirect;
  if (depth == 1) return PathClass::direct;
  return caustic ? PathClass::caustic : PathClass::indirect;
}

/// The vertices of light paths at which photons are merged, sorted for queries of a largest radius.
class MergeMap {
 public:
  MergeMap() = default;
  /// Vertices of `least_depth` and more, of one class.
  MergeMap(const LightVertices& vertices, int least_depth, float radius, int flux_class = 0) {
    std::vector<const LightVertex*> merged;
    std::vector<Point> positions;
    for (std::size_t c = 0; c < vertices.chunk_count(); ++c) {
      const LightVertices::Chunk& chunk = vertices.chunk(c);
      for (const LightVertex& v : chunk.vertices)
        if (!v.phase && v.flux_class == flux_class && v.depth >= least_depth && merges_at(v.at)) {
          merged.push_back(&v);
          positions.push_back(v.at.position);
        }
    }
    IndexBuild<HashGrid> built = HashGrid::build(positions, radius);
    grid_ = std::move(built.index);
    photons_.resize(merged.size());
    parallel_chunks(merged.size(), 1u << 13, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot) {
        const LightVertex& v = *merged[built.order[slot]];
        const Spectrum power = v.beta * grazing_gain(geometric_cosine(v.at, v.wi));
        photons_[slot] = {power,     v.wi,       v.distance, v.densities, static_cast<std::uint16_t>(v.depth),
                          v.caustic, v.dispersed};
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
  HashGrid grid_;
  std::vector<MergePhoton> photons_;
};

}  // namespace lanthorn
