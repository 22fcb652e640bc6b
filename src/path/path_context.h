// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>

#include "lanthorn/statistics.h"
#include "math/sampler.h"
#include "scene/scene.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Ray counts to which several threads add.
class SharedRayCounts {
 public:
  void add(const RayCounts& counts) {
    const std::lock_guard lock(mutex_);
    sum_ += counts;
  }
  /// To be called when all threads have added their counts.
  const RayCounts& sum() const { return sum_; }

 private:
  std::mutex mutex_;
  RayCounts sum_;
};

struct WalkLimits {
  int max_depth = 64;      ///< scattering events of a walk, at most
  int roulette_depth = 1;  ///< Russian roulette from this scattering event on
};

/// Everything that a path needs at each of its vertices.
struct PathContext {
  const Scene& scene;
  const Wavelengths& w;
  Sampler& sampler;   ///< of this path
  RayCounts& counts;  ///< rays traced are added here
  WalkLimits limits = {};

  /// The same for a branch, whose random numbers are its own.
  PathContext with(Sampler& branch) const { return {scene, w, branch, counts, limits}; }
};

/// Sampler dimensions of a path: two groups for its start, then two for each vertex, one for the walk and one for its
/// visitor.
constexpr std::uint32_t walk_dimensions(int depth) { return 2 * static_cast<std::uint32_t>(depth); }
constexpr std::uint32_t visitor_dimensions(int depth) { return 2 * static_cast<std::uint32_t>(depth) + 1; }

}  // namespace lanthorn
