// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Tests of the discs in which photons are gathered: whether their photons are evenly distributed, and whether
// the surface is flat.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "math/frame.h"
#include "math/vec.h"
#include "path/path_context.h"
#include "path/vertex.h"

namespace lanthorn {

/// Four quadrants, inside and outside of half the area.
inline constexpr std::size_t disc_sectors = 8;
using SectorCounts = std::array<std::uint32_t, disc_sectors>;

/// The sector of a photon at this offset from the centre, in a frame whose z axis is the disc's normal.
inline std::size_t sector_of(const Vec3& offset, bool in_outer_half) {
  return (offset.x > 0 ? 1u : 0u) + (offset.y > 0 ? 2u : 0u) + (in_outer_half ? 4u : 0u);
}

/// Whether the counts reject a uniform density at the 5 % level, by the chi-squared test of Lin et al. 2020 ("CPPM:
/// chi-squared progressive photon mapping"), which counts photons in sectors of equal area. `total`: their sum, > 0.
inline bool rejects_uniformity(const SectorCounts& counts, float total) {
  constexpr float critical = 14.067f;  // chi-squared of 7 degrees of freedom, 5 %
  const float expected = total / disc_sectors;
  float chi2 = 0;
  for (const std::uint32_t count : counts) chi2 += sqr(static_cast<float>(count) - expected) / expected;
  return chi2 >= critical;
}

/// Tests whether the light of the photons in a disc is even: the null hypothesis is that irradiance is constant on the
/// disc. Let (x, y) be a photon's place in the unit disc, w its weight and u_j one of x, y, x² + y² - 1/2, x² - y² and
/// 2xy. These functions are orthogonal and have mean 0 over the disc. For independent photons under even light, each
/// Σ w u_j / √(Var(u_j) Σ w²) has mean 0 and variance 1, so that their squares add up to about a χ² of 5 degrees of
/// freedom (a score test: Cox & Hinkley 1974, "Theoretical Statistics", section 9.3). An edge of light moves the
/// first two sums, a line or a spot of light the other three. Unlike `rejects_uniformity`, the
/// test also sees photons of unequal power.
class DiscEvenness {
 public:
  /// With fewer photons of equal light, the test would miss an edge through the middle of the disc.
  static constexpr std::size_t fewest = 24;

  explicit DiscEvenness(const Normal& normal) : frame_(normal) {}

  /// `offset`: of the photon from the disc's centre, divided by the disc's radius. `weight` >= 0: its light, any unit.
  void add(const Vec3& offset, float weight) {
    const Vec3 local = frame_.to_local(offset);
    const float x2 = local.x * local.x, y2 = local.y * local.y;
    first_ += weight * Vec2(local.x, local.y);
    second_ += weight * Vec3(x2 + y2 - 0.5f, x2 - y2, 2 * local.x * local.y);
    sum_ += weight;
    squares_ += weight * weight;
  }

  /// Whether the photons are enough for the test, and it does not reject even light at the 5 % level. Photons of
  /// unequal light are worth (Σ w)² / Σ w² equal ones.
  bool is_even() const {
    constexpr float critical = 11.070f;  // χ² of 5 degrees of freedom, 5 %
    const Vec3 squares = second_ * second_;
    // The variances of the functions over the disc are 1/4, 1/4, 1/12, 1/6 and 1/6.
    const float chi2 = 4 * (first_.x * first_.x + first_.y * first_.y) + 12 * squares.x + 6 * (squares.y + squares.z);
    return sum_ * sum_ >= static_cast<float>(fewest) * squares_ && chi2 < critical * squares_;
  }

 private:
  Frame frame_;
  Vec2 first_{0};
  Vec3 second_{0};
  float sum_ = 0, squares_ = 0;
};

/// True if the disc of this radius (m) around a vertex of an eye path lies on surfaces of its plane, and if nothing
/// stands on its visible side, as far as rays to eight points of its edge can tell.
bool is_flat_and_clear(const PathContext& path, const SurfaceVertex& vertex, float radius);

}  // namespace lanthorn
