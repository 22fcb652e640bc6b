// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>

#include "base/parallel.h"
#include "light/light_sampler.h"
#include "path/walk.h"

namespace lanthorn {

/// The light paths of one pass.
struct LightPass {
  std::uint64_t seed = 0;
  Stream stream = Stream::light;
  std::uint32_t pass = 0;
  std::uint64_t paths = 0;  ///< to be emitted by all lights together
};

/// Light paths per chunk of work. Fixed, so that what a chunk does never depends on the number of threads.
inline constexpr std::size_t light_path_chunk = 2048;

/// Shares the pass's paths among the lights (PhotonAllocation).
inline PhotonAllocation allocate_light_paths(const Scene& scene, const LightPass& pass) {
  Sampler sampler = Sampler::for_pass(pass.seed ^ static_cast<std::uint64_t>(pass.stream), pass.pass);
  sampler.seek(1);
  return PhotonAllocation(scene.lights(), pass.paths, sampler.next());
}

/// Calls `body(path, sampler, counts, chunk)` for the light paths [begin, end) of the pass, in order.
template <class Body>
void for_each_light_path_in(const Scene& scene, const LightPass& pass, const PhotonAllocation& allocation,
                            std::size_t begin, std::size_t end, Body&& body) {
  const std::span<const PhotonAllocation::Share> shares = allocation.shares();
  auto share = std::upper_bound(shares.begin(), shares.end(), begin,
                                [](std::size_t i, const PhotonAllocation::Share& s) { return i < s.begin; });
  --share;
  for (std::size_t i = begin; i < end; ++i) {
    while (i >= share->begin + share->count) ++share;
    Sampler sampler = Sampler::for_light_path(pass.seed, pass.stream, share->light, pass.pass,
                                              static_cast<std::uint32_t>(i - share->begin));
    body(LightPath{scene.lights()[share->light], share->weight}, sampler);
  }
}

/// Calls `body(path, sampler, counts)` for every light path of the pass, in parallel; sets `emitted` to their number.
template <class Body>
RayCounts for_each_light_path(const Scene& scene, const LightPass& pass, std::uint64_t& emitted, Body&& body) {
  const PhotonAllocation allocation = allocate_light_paths(scene, pass);
  emitted = allocation.total();
  std::atomic<std::uint64_t> walk_rays{0}, shadow_rays{0};
  parallel_chunks(allocation.total(), light_path_chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    RayCounts counts;
    for_each_light_path_in(scene, pass, allocation, begin, end,
                           [&](const LightPath& path, Sampler& sampler) { body(path, sampler, counts); });
    walk_rays += counts.walk;
    shadow_rays += counts.shadow;
  });
  return {walk_rays, shadow_rays};
}

}  // namespace lanthorn
