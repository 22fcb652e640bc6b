// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "light/light_sampler.h"
#include "path/walk.h"

namespace lanthorn {

/// The light paths of one pass.
struct LightPass {
  std::uint64_t seed = 0;
  Stream stream = Stream::light;
  std::uint32_t pass = 0;
  std::uint64_t paths = 0;  ///< emitted by all lights together
  const EmissionGuide* guide = nullptr;
};

/// Light paths per chunk of work. Fixed, so that chunks do not depend on the number of threads.
inline constexpr std::size_t light_path_chunk = 2048;

/// The light paths of a pass, distributed among the lights by PhotonAllocation, in the order in which they are traced.
/// In large scenes the order follows a space-filling curve through the points that the paths are likely to hit first:
/// consecutive paths then read the same parts of the scene while these are in the CPU's cache. The order does not
/// change the set of paths.
class LightPaths {
 public:
  LightPaths(const Scene& scene, const LightPass& pass);

  std::uint64_t total() const { return allocation_.total(); }
  std::size_t chunk_count() const { return (total() + light_path_chunk - 1) / light_path_chunk; }

  /// Calls `body(start, sampler, counts, chunk)` for every path, in parallel. `chunk` < chunk_count() is the chunk of
  /// work that the path belongs to. One thread runs all paths of a chunk in order, so results kept for each chunk do
  /// not depend on the number of threads. Returns the sum of the ray counts.
  template <class Body>
  RayCounts for_each(Body&& body) const {
    SharedRayCounts rays;
    parallel_chunks(total(), light_path_chunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      RayCounts counts;
      for_each_in(begin, end, [&](const LightPath& start, Sampler& sampler) { body(start, sampler, counts, chunk); });
      rays.add(counts);
    });
    return rays.sum();
  }

 private:
  template <class Body>
  void for_each_in(std::size_t begin, std::size_t end, Body&& body) const {
    const PhotonAllocation::Share* share = &allocation_.shares().front();
    for (std::size_t i = begin; i < end; ++i) {
      stop_point();
      const std::uint64_t number = order_.empty() ? i : order_[i];
      if (number - share->begin >= share->count) share = &share_of(number);
      Sampler sampler = sampler_of(number, *share);
      body(path_of(*share), sampler);
    }
  }
  const PhotonAllocation::Share& share_of(std::uint64_t number) const;
  Sampler sampler_of(std::uint64_t number, const PhotonAllocation::Share& share) const {
    return Sampler::for_light_path(pass_.seed, pass_.stream, share.light, pass_.pass,
                                   static_cast<std::uint32_t>(number - share.begin));
  }
  LightPath path_of(const PhotonAllocation::Share& share) const {
    return {scene_.lights()[share.light], share.light, share.weight, pass_.guide};
  }
  std::vector<std::uint32_t> coherent_order() const;

  const Scene& scene_;
  LightPass pass_;
  PhotonAllocation allocation_;
  std::vector<std::uint32_t> order_;  // numbers of the paths; empty: ascending
};

}  // namespace lanthorn
