// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "light/light.h"
#include "math/tree_distribution.h"

namespace lanthorn {

/// Concentric disks of growing radii around a place. Photons of far lights start on each of them equally often, instead
/// of on the one disk that covers the scene: in a large world almost none of those photons would reach a small place.
/// The density falls with the squared distance from the place. The largest disk covers the scene, so no photon has more
/// than `count` times the flux that it would have without the disks.
struct AimedDisks {
  static constexpr int count = 8;  ///< a power of two: halving the domain of the numbers then separates the disks

  BoundingSphere scene;
  Point centre{0};  ///< of all disks except the largest, which is centred on the scene

  /// `smallest`: radius, m.
  AimedDisks(const BoundingSphere& scene, const Point& centre, float smallest);

  /// Moves the photon's origin to the point of the disks for `u` in [0,1)² and scales its flux, which becomes black if
  /// the point lies outside the disk that covers the scene. Does not change `pdf_position`.
  void move(EmissionSample& emission, const Vec2& u) const;
  /// Ratio of the density of photons along the ray through `p` to the density of photons that start uniformly on the
  /// disk covering the scene. `numbers`: density of the photons' four random numbers. `u_direction`: the two numbers of
  /// the ray's direction, if the light has an inverse for them. `enough`: see `guided_density`.
  float density(const Point& p, const Direction& direction, const TreeDistribution& numbers,
                const std::optional<Vec2>& u_direction, float enough) const;
  /// Radius (m) of a disk, from 0 to count - 1.
  float radius(int disk) const { return radius_[static_cast<unsigned>(disk)]; }

 private:
  std::array<float, count> radius_{};
};

/// Guided emission of light paths. Every light samples its emission from four numbers, two for the position and two for
/// the direction (`sample_emission`). A guide draws these four from a learned density instead of uniformly and divides
/// the photon's flux by that density, so the estimators stay unbiased.
struct EmissionGuide {
  struct OfLight {
    TreeDistribution numbers;
    float relevance = 1;  ///< photons of this light per watt, up to a factor common to all lights; > 0
  };
  std::vector<OfLight> lights;  ///< by index of the light; as many as the scene has
  std::optional<AimedDisks> disks{};

  /// A guide that changes nothing yet, for a scene with `light_count` lights.
  explicit EmissionGuide(std::size_t light_count, const std::optional<AimedDisks>& disks_ = {})
      : lights(light_count), disks(disks_) {}
};

/// Ratio of the density of photons of light `index` along a ray with the guide to the density without it, averaged over
/// the numbers that `invert_emission` leaves empty. `origin`: as for `invert_emission`. A ratio above `enough` need not
/// be exact: the result then lies between `enough` and the ratio.
float guided_density(const EmissionGuide& guide, const Light& light, std::uint32_t index, const EmitterHit& origin,
                     const Direction& direction, float enough = infinity);

/// Samples the emission of a photon from four numbers. The densities in the sample are the light's own, without the
/// guide. `disks` may be null.
std::optional<EmissionSample> sample_emission(const Light& light, const AimedDisks* disks,
                                              const TreeDistribution::Numbers& u, const Wavelengths& w);

}  // namespace lanthorn
