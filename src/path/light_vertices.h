// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Vertices of a pass's light paths, kept for eye paths to connect to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "path/light_pass.h"
#include "path/subpath.h"

namespace lanthorn {

/// A vertex of a light path, on a surface or in a medium.
struct LightVertex {
  SurfacePoint at;  ///< in a medium position and time alone
  Direction wi{0, 0, 1};
  Vec3 wi_local{0};                       ///< on surfaces
  std::optional<HenyeyGreenstein> phase;  ///< in a medium
  Spectrum beta;                          ///< flux that arrives, over the light paths of the pass
  SubpathDensities densities;
  MediumId medium = MediumId::vacuum;  ///< that the path has come through
  int depth = 0;
  bool caustic = false;  ///< delta scatterings alone so far
  bool dispersed = false;
  std::uint32_t trail_begin = 0;  ///< of its path, in Chunk::trails
};

/// The vertices of all light paths of a pass, each path's one after the other. A path's number is its place in
/// LightPaths' order.
class LightVertices {
 public:
  /// Forgets all vertices. `chunks`: of LightPaths.
  void begin(std::size_t chunks) {
    chunks_.resize(chunks);
    for (Chunk& chunk : chunks_) chunk.clear();
  }
  std::size_t chunk_count() const { return chunks_.size(); }

  /// What one thread fills, path by path.
  struct Chunk {
    std::vector<LightVertex> vertices;
    std::vector<std::uint32_t> ends;  ///< of each path, in `vertices`
    std::vector<TrailVertex> trails;  ///< of all paths, if weights want them

    std::span<const TrailVertex> trail(const LightVertex& v) const {
      if (trails.empty()) return {};
      return std::span(trails).subspan(v.trail_begin, static_cast<std::size_t>(v.depth) + 1);
    }
    void clear() {
      vertices.clear();
      ends.clear();
      trails.clear();
    }
  };
  Chunk& chunk(std::size_t i) { return chunks_[i]; }
  const Chunk& chunk(std::size_t i) const { return chunks_[i]; }

  /// The light's point and all vertices up to `v`, delta ones too, of the path of that number; empty if not kept.
  std::span<const TrailVertex> trail(std::size_t number, const LightVertex& v) const {
    return chunks_[number / light_path_chunk].trail(v);
  }
  std::span<const LightVertex> path(std::size_t number) const {
    if (chunks_.empty()) return {};  // a scene without light
    const Chunk& c = chunks_[number / light_path_chunk];
    const std::size_t i = number % light_path_chunk;
    const std::uint32_t begin = i == 0 ? 0 : c.ends[i - 1];
    return std::span(c.vertices).subspan(begin, c.ends[i] - begin);
  }

 private:
  std::vector<Chunk> chunks_;
};

}  // namespace lanthorn
