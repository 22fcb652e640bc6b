// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "light/light_sampler.h"
#include "path/walk.h"

namespace lanthorn {

/// Light paths per chunk of work. Fixed, so that chunks do not depend on the number of threads.
inline constexpr std::size_t light_path_chunk = 2048;

/// Consecutive light paths of a pass. Their photons are traced and kept together, before the next block begins.
struct LightPathBlock {
  std::uint64_t begin = 0;
  std::uint64_t end = std::numeric_limits<std::uint64_t>::max();  ///< the last block has all the rest
};

/// Divides the light paths of a pass into blocks of equal sizes.
class LightPathBlocks {
 public:
  /// Blocks of at most `size` paths; at least one block.
  LightPathBlocks(std::uint64_t paths, std::uint64_t size)
      : size_(std::max<std::uint64_t>(size, 1)),
        count_(static_cast<std::uint32_t>(std::max<std::uint64_t>(paths / size_ + (paths % size_ > 0 ? 1 : 0), 1))) {}

  std::uint32_t count() const { return count_; }
  LightPathBlock operator[](std::uint32_t i) const {
    if (i + 1 == count_) return {i * size_};
    return {i * size_, (i + 1) * size_};
  }

 private:
  std::uint64_t size_;
  std::uint32_t count_;
};

/// The light paths of one pass.
struct LightPass {
  std::uint64_t seed = 0;
  Stream stream = Stream::light;
  std::uint32_t pass = 0;
  std::uint64_t paths = 0;  ///< emitted by all lights together
  const EmissionGuide* guide = nullptr;
  LightPathBlock block = {};  ///< the part of these paths that is traced
  bool is_in_order = false;   ///< traces paths in ascending order even in large scenes
};

/// The light paths of a pass, distributed among the lights by PhotonAllocation, or one block of them, in the order in
/// which they are traced. In large scenes the order follows a space-filling curve through the points that the paths are
/// likely to hit first: consecutive paths then read the same parts of the scene while these are in the CPU's cache. The
/// order does not change the set of paths.
class LightPaths {
 public:
  LightPaths(const Scene& scene, const LightPass& pass);
  /// Goes on to another block of the pass.
  void begin_block(const LightPathBlock& block);

  std::uint64_t total() const { return allocation_.total(); }  ///< of the pass
  std::uint64_t first() const { return first_; }               ///< number of the block's first path
  std::uint64_t count() const { return count_; }               ///< of the block
  std::size_t chunk_count() const { return (count() + light_path_chunk - 1) / light_path_chunk; }

  /// Calls `body(start, sampler, counts, chunk)` for every path, in parallel. `chunk` < chunk_count() is the chunk of
  /// work that the path belongs to. One thread runs all paths of a chunk in order, so results kept for each chunk do
  /// not depend on the number of threads. Returns the sum of the ray counts.
  template <class Body>
  RayCounts for_each(Body&& body) const {
    SharedRayCounts rays;
    parallel_chunks(count(), light_path_chunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      RayCounts counts;
      for_each_in(begin, end, [&](const LightPath& start, Sampler& sampler) { body(start, sampler, counts, chunk); });
      rays.add(counts);
    });
    return rays.sum();
  }

  /// The random numbers of a path of any block. Precondition: the paths are in order, and number < total().
  Sampler sampler_of(std::uint64_t number) const { return sampler_of(number, share_of(number)); }

 private:
  template <class Body>
  void for_each_in(std::size_t begin, std::size_t end, Body&& body) const {
    const PhotonAllocation::Share* share = &allocation_.shares().front();
    for (std::size_t i = begin; i < end; ++i) {
      stop_point();
      const std::uint64_t number = first_ + (order_.empty() ? i : order_[i]);
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
  std::uint64_t first_ = 0, count_ = 0;  // of the block
  std::vector<std::uint32_t> order_;     // numbers of the paths in the block; empty: ascending
};

}  // namespace lanthorn
