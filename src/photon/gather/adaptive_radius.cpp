// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/gather/adaptive_radius.h"

#include "photon/gather/radius_schedule.h"

namespace lanthorn {

namespace {

// Bounds between which the picture converges for any statistics: above them bias would remain, below them noise.
constexpr double slowest = 0.9, fastest = 0.4;  // alpha

}  // namespace

void LeastErrorRadius::update(const Tally& tally, const AdaptiveRadiusSettings& s) {
  squares_ += tally.squares / (pi * tally.support2);
  laplacian_ += tally.laplacian;
  laplacian_variance_ += tally.laplacian_variance;
  ++gathers_;
  widest_ = first_ * RadiusSchedule{1, slowest}.radius(gathers_);
  const float narrowest = first_ * RadiusSchedule{1, fastest}.radius(gathers_);

  const auto n = static_cast<float>(gathers_);
  // The expected square of a noisy mean exceeds the square of its expectation by the mean's variance.
  const float laplacian2 = std::max(0.0f, sqr(laplacian_ / n) - laplacian_variance_ / sqr(n));
  const float bias2 = sqr(s.moments.second / 2) * laplacian2;
  const float variance = squares_ / n * s.moments.roughness;
  if (!(variance > 0)) return;
  const float best = std::pow(variance / (6 * n * bias2), 1.0f / 6) / s.kernel.support(1);
  radius_ = std::fmax(narrowest, std::fmin(best, widest_));  // the widest if sums overflowed, so that `best` is NaN
}

void ChiSquaredRadius::update(const Tally& tally, const AdaptiveRadiusSettings&) {
  constexpr float fewest = 5 * disc_sectors;  // photons that the test needs: 5 per sector
  constexpr float shrink = 0.86602540378f;    // factor of the radius; the area shrinks to three quarters
  ++gathers_;
  float total = 0;
  for (std::size_t i = 0; i < disc_sectors; ++i) {
    counts_[i] += tally.counts[i];
    total += static_cast<float>(counts_[i]);
  }
  radius_ = std::min(radius_, first_ * RadiusSchedule{1, slowest}.radius(gathers_));
  if (total < fewest || !rejects_uniformity(counts_, total)) return;
  radius_ = std::max(shrink * radius_, first_ * RadiusSchedule{1, fastest}.radius(gathers_));
  counts_ = {};
}

}  // namespace lanthorn
