// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The vertices of a pass's light paths, to which eye paths are connected.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/prefetch.h"
#include "path/light_pass.h"
#include "path/subpath.h"

namespace lanthorn {

/// A vertex of a light path, on a surface or in a medium.
struct LightVertex {
  SurfacePoint at;  ///< in a medium, only position and time are set
  Direction wi{0, 0, 1};
  Vec3 wi_local{0};                       ///< on surfaces
  std::optional<HenyeyGreenstein> phase;  ///< in a medium
  float distance = 0;                     ///< to the vertex before, m
  Spectrum beta;                          ///< incident flux, divided by the number of light paths of the pass
  VertexDensities densities;
  FlightDensity flight;
  float coherence = 1;                 ///< of its scattering (path/coherence.h); 1 without merging in media
  MediumId medium = MediumId::vacuum;  ///< the medium along the segment to this vertex
  int depth = 0;
  int scatterings = 0;   ///< as in WalkState
  bool caustic = false;  ///< the path has scattered by delta lobes only
  bool dispersed = false;
  bool has_own_dispersion = false;  ///< see `meet_others`
  std::uint8_t flux_class = 0;      ///< where photons are merged by classes of flux

  /// Prepares it for eye paths whose heroes differ from that of its path, `w` (`LightToMeet`). In spectral mode its
  /// beta then has the factor of its path's dispersion, including that of its own surface: this light is a part of what
  /// arrives, and the mean over the heroes is the same.
  void meet_others(const Wavelengths& w) {
    if (w.mode == ColorMode::rgb) return;
    has_own_dispersion = true;
    const bool disperses = dispersed || (!phase && is_dispersive(at.bsdf));
    const LightToMeet own = LightToMeet::of(beta, disperses, w);
    beta = own.light;
    dispersed = own.dispersed;
  }
};

/// A flight of a light path through a medium, up to the next surface.
struct LightBeam {
  Point origin{0};
  Direction direction{0, 0, 1};
  float length = 0;  ///< m
  float time = 0;
  MediumId medium = MediumId::vacuum;
  Spectrum beta;        ///< flux at the origin, divided by the number of light paths of the pass that have beams
  Departure departure;  ///< how the subpath left its last vertex for this flight
  PathStart start;
  int depth = 0;        ///< of a vertex on the flight
  int scatterings = 0;  ///< of such a vertex, as in WalkState
  bool caustic = false;
  bool dispersed = false;
};

/// The vertices of the light paths of a pass or of one of its blocks, path by path. A path's number is its position in
/// the order of LightPaths.
class LightVertices {
 public:
  /// Removes all vertices. `chunks` is LightPaths::chunk_count().
  void begin(std::size_t chunks) {
    chunks_.resize(chunks);
    for (Chunk& chunk : chunks_) chunk.clear();
  }
  std::size_t chunk_count() const { return chunks_.size(); }

  /// Filled by one thread, path by path.
  struct Chunk {
    std::vector<LightVertex> vertices;
    std::vector<std::uint32_t> ends;  ///< for each path, the end of its vertices in `vertices`
    std::vector<LightBeam> beams;     ///< of some paths, where flights are merged

    void clear() {
      vertices.clear();
      ends.clear();
      beams.clear();
    }
  };
  Chunk& chunk(std::size_t i) { return chunks_[i]; }
  const Chunk& chunk(std::size_t i) const { return chunks_[i]; }

  std::span<const LightVertex> path(std::size_t number) const {
    if (chunks_.empty()) return {};  // a scene without light
    const Chunk& c = chunks_[number / light_path_chunk];
    const std::size_t i = number % light_path_chunk;
    const std::uint32_t begin = i == 0 ? 0 : c.ends[i - 1];
    return std::span(c.vertices).subspan(begin, c.ends[i] - begin);
  }
  /// Prefetches what `path(number)` reads to find the path's vertices.
  void prefetch_place(std::size_t number) const {
    if (chunks_.empty()) return;
    const std::vector<std::uint32_t>& ends = chunks_[number / light_path_chunk].ends;
    if (const std::size_t i = number % light_path_chunk; i < ends.size()) prefetch(ends[i]);
  }
  /// The vertices for which `is_wanted` returns true, path by path. Found in parallel.
  template <class Predicate>
  std::vector<const LightVertex*> select(Predicate&& is_wanted) const {
    std::vector<std::size_t> first(chunks_.size() + 1);  // of a chunk
    parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
      first[c + 1] = static_cast<std::size_t>(std::ranges::count_if(chunks_[c].vertices, is_wanted));
    });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<const LightVertex*> selected(first.back());
    parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
      std::size_t i = first[c];
      for (const LightVertex& v : chunks_[c].vertices)
        if (is_wanted(v)) selected[i++] = &v;
    });
    return selected;
  }

 private:
  std::vector<Chunk> chunks_;
};

}  // namespace lanthorn
