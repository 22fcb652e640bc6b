// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Whether the photons of a disc are uniformly distributed, by the chi-squared test of Lin et al. 2020 ("CPPM:
// chi-squared progressive photon mapping"): photons are counted in sectors of equal area.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "math/vec.h"

namespace lanthorn {

/// Four quadrants, inside and outside of half the area.
inline constexpr std::size_t disc_sectors = 8;
using SectorCounts = std::array<std::uint32_t, disc_sectors>;

/// The sector of a photon at this offset from the centre, in a frame whose z axis is the disc's normal.
inline std::size_t sector_of(const Vec3& offset, bool in_outer_half) {
  return (offset.x > 0 ? 1u : 0u) + (offset.y > 0 ? 2u : 0u) + (in_outer_half ? 4u : 0u);
}

/// Whether the counts reject a uniform density at the 5 % level. `total`: their sum, > 0.
inline bool rejects_uniformity(const SectorCounts& counts, float total) {
  constexpr float critical = 14.067f;  // chi-squared of 7 degrees of freedom, 5 %
  const float expected = total / disc_sectors;
  float chi2 = 0;
  for (const std::uint32_t count : counts) chi2 += sqr(static_cast<float>(count) - expected) / expected;
  return chi2 >= critical;
}

}  // namespace lanthorn
