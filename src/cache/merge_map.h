// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons with what merging weights need of them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "cache/hash_grid.h"
#include "path/light_vertices.h"

namespace lanthorn {

/// A photon to be merged; its position is the index's.
struct MergePhoton {
  Spectrum power;  ///< watts, over the light paths of the pass
  Direction wi{0, 0, 1};
  float vcm = 0, vm = 0;  ///< SubpathDensities
  std::uint16_t depth = 0;
  bool caustic = false;
  bool dispersed = false;
  const TrailVertex* trail = nullptr;  ///< of its `depth` + 1 path vertices, if weights want them
};

/// The vertices of light paths at which photons are merged, sorted for queries of one radius.
class MergeMap {
 public:
  MergeMap() = default;
  MergeMap(const LightVertices& vertices, float radius) {
    struct Merged {
      const LightVertex* vertex;
      const TrailVertex* trail;
    };
    std::vector<Merged> merged;
    std::vector<Point> positions;
    for (std::size_t c = 0; c < vertices.chunk_count(); ++c)
      for (const LightVertex& v : vertices.chunk(c).vertices)
        if (!v.phase && merges_at(v.at)) {
          merged.push_back({&v, vertices.chunk(c).trail(v).data()});
          positions.push_back(v.at.position);
        }
    IndexBuild<HashGrid> built = HashGrid::build(positions, radius);
    grid_ = std::move(built.index);
    photons_.resize(merged.size());
    parallel_chunks(merged.size(), 1u << 13, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot) {
        const LightVertex& v = *merged[built.order[slot]].vertex;
        photons_[slot] = {v.beta,
                          v.wi,
                          v.densities.vcm,
                          v.densities.vm,
                          static_cast<std::uint16_t>(v.depth),
                          v.caustic,
                          v.dispersed,
                          merged[built.order[slot]].trail};
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
  std::size_t memory_bytes() const { return grid_.memory_bytes() + photons_.size() * sizeof(MergePhoton); }

 private:
  HashGrid grid_;
  std::vector<MergePhoton> photons_;
};

}  // namespace lanthorn
