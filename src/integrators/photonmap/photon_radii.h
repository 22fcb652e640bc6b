// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Kernel radii of photons, for methods in which photons look for points instead of points for photons.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "index/bucket_kdtree.h"
#include "photon/gather/radiance_estimate.h"
#include "photon/photon_map.h"

namespace lanthorn {

/// Source of a photon's radius: the distance to its k-th neighbour, or the diagonal and the number of photons of its
/// leaf in the kd-tree, which needs no search (Havran et al. 2005).
enum class RadiusRule : std::uint8_t { nearest, leaf };

namespace photon_radii_detail {

template <class Map>
float nearest_radius(const Map& map, const Point& p, const EstimateSettings& settings) {
  // One more, because the query finds the photon itself.
  std::array<Neighbour, EstimateSettings::most_nearest + 1> memory;
  const std::size_t wanted = std::min(settings.nearest, EstimateSettings::most_nearest) + 1;
  const std::span<const Neighbour> found = map.nearest(p, settings.radius, std::span(memory).first(wanted));
  return found.size() == wanted ? std::sqrt(found.front().dist2) : settings.radius;
}

/// Radius from a leaf. For n photons distributed evenly on a square of diagonal d, a disc with k of them has
/// π r² = k/n · d²/2. The bounding box of n points is smaller than the square: of n+1 gaps along each side it spans
/// n-1.
inline float leaf_radius(const Bounds& bounds, std::size_t count, const EstimateSettings& settings) {
  if (count < 2) return settings.radius;
  const auto n = static_cast<float>(count);
  const float diagonal2 = length_squared(bounds.extent()) * sqr((n + 1) / (n - 1));
  return std::sqrt(static_cast<float>(settings.nearest) / n * diagonal2 / 2 * inv_pi);
}

}  // namespace photon_radii_detail

/// Kernel radius of each photon, by slot, m. By the given rule the disc holds `settings.nearest` photons; the radius is
/// at most `settings.radius`. If `nearest` is 0, every radius is the support of the kernel whose equivalent box kernel
/// has radius `settings.radius`.
inline std::vector<float> photon_radii(const PhotonMap<BucketKdTree>& map, const EstimateSettings& settings,
                                       RadiusRule rule) {
  std::vector<float> radii(map.size(), settings.kernel.support(settings.radius));
  if (settings.nearest == 0) return radii;
  // A lower bound for coincident photons, whose radius would be 0.
  const auto bounded = [&](float r) { return std::clamp(r, 1e-3f * settings.radius, settings.radius); };
  const BucketKdTree& tree = map.index();
  if (rule == RadiusRule::leaf) {
    tree.for_each_leaf([&](SlotRange range) {
      Bounds bounds;
      for (std::uint32_t slot = range.begin; slot < range.end; ++slot) bounds.extend(tree.position(slot));
      const float radius = photon_radii_detail::leaf_radius(bounds, range.end - range.begin, settings);
      std::fill(radii.begin() + range.begin, radii.begin() + range.end, bounded(radius));
    });
    return radii;
  }
  constexpr std::size_t chunk = 1024;
  parallel_chunks(radii.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot)
      radii[slot] =
          bounded(photon_radii_detail::nearest_radius(map, tree.position(static_cast<std::uint32_t>(slot)), settings));
  });
  return radii;
}

}  // namespace lanthorn
