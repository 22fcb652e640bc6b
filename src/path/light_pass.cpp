// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/light_pass.h"

#include <limits>

#include "base/parallel_sort.h"

namespace lanthorn {

namespace {

// Number of triangles from which on a scene exceeds a core's private cache.
constexpr std::uint64_t large_scene = 8192;

PhotonAllocation allocate(const Scene& scene, const LightPass& pass) {
  Sampler sampler = Sampler::for_pass(pass.seed ^ static_cast<std::uint64_t>(pass.stream), pass.pass);
  sampler.seek(1);
  return PhotonAllocation(scene.lights(), pass.paths, sampler.next(), pass.guide);
}

// Inserts two zero bits before each of the ten lowest bits.
constexpr std::uint32_t spread_bits(std::uint32_t x) {
  x &= 0x3ffu;
  x = (x | (x << 16)) & 0x30000ffu;
  x = (x | (x << 8)) & 0x300f00fu;
  x = (x | (x << 4)) & 0x30c30c3u;
  return (x | (x << 2)) & 0x9249249u;
}

// Morton code of the point at half the scene's extent along the ray. The path is likely to land near this point; for
// small lights the code sorts by direction.
std::uint32_t flight_code(const EmissionSample& emission, const BoundingSphere& sphere) {
  const Point ahead = emission.origin + sphere.radius * emission.direction;
  const Vec3 unit = 0.25f * (ahead - sphere.centre) / sphere.radius + Vec3(0.5f);
  const auto cell = [](float x) { return static_cast<std::uint32_t>(std::clamp(1024 * x, 0.0f, 1023.0f)); };
  return spread_bits(cell(unit.x)) | spread_bits(cell(unit.y)) << 1 | spread_bits(cell(unit.z)) << 2;
}

}  // namespace

LightPaths::LightPaths(const Scene& scene, const LightPass& pass)
    : scene_(scene), pass_(pass), allocation_(allocate(scene, pass)) {
  begin_block(pass.block);
}

void LightPaths::begin_block(const LightPathBlock& block) {
  first_ = std::min(block.begin, total());
  count_ = std::min(block.end, total()) - first_;
  const SceneStatistics& s = scene_.statistics();
  if (s.triangles + s.patches >= large_scene && !pass_.is_in_order &&
      count_ <= std::numeric_limits<std::uint32_t>::max())
    order_ = coherent_order();
}

const PhotonAllocation::Share& LightPaths::share_of(std::uint64_t number) const {
  const std::span<const PhotonAllocation::Share> shares = allocation_.shares();
  return *--std::upper_bound(shares.begin(), shares.end(), number,
                             [](std::uint64_t i, const PhotonAllocation::Share& s) { return i < s.begin; });
}

std::vector<std::uint32_t> LightPaths::coherent_order() const {
  std::vector<std::uint64_t> keys(count_);
  const Wavelengths any = Wavelengths::rgb(0.5f);  // position and direction do not depend on them
  parallel_chunks(keys.size(), light_path_chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t number = first_ + i;
      const PhotonAllocation::Share& share = share_of(number);
      Sampler sampler = sampler_of(number, share);
      const std::optional<EmissionSample> emission = sample_emission_of(path_of(share), sampler, any);
      const std::uint64_t code = emission ? flight_code(*emission, scene_.bounding_sphere()) : 0;
      keys[i] = code << 32 | i;
    }
  });
  parallel_sort(keys);
  std::vector<std::uint32_t> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(),
                 [](std::uint64_t k) { return static_cast<std::uint32_t>(k); });
  return order;
}

}  // namespace lanthorn
