// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The loops over candidates run for each contribution. They are plain, so that compilers make vector instructions of
// them.
#include "integrators/auto/moments.h"

#include <cmath>

namespace lanthorn {

void CandidateArrays::ratios(const TechniqueSum& s, std::size_t first, std::span<float> result) const {
  constexpr float least_ratio = 1e-6f;  // stands in for 0: the candidate cannot find the path
  const std::size_t count = result.size();
  const float all = s.all();
  const auto from = [&](float TechniqueDensities::*technique) { return samples(technique).data() + first; };
  const float* const walk = from(&TechniqueDensities::walk);
  const float* const lens = from(&TechniqueDensities::lens);
  const float* const connections = from(&TechniqueDensities::connections);
  const float* const merging = from(&TechniqueDensities::merging);
  const float* const media = from(&TechniqueDensities::media);
  const float* const goes_on = goes_on_.data() + first;
  float* const ratios = result.data();
  const auto density = [=](const TechniqueDensities& d, std::size_t i) {
    return walk[i] * d.walk + lens[i] * d.lens + connections[i] * d.connections + merging[i] * d.merging +
           media[i] * d.media;
  };
  const TechniqueDensities within = s.within, beyond = s.beyond;
  for (std::size_t i = 0; i < count; ++i) {
    const float ratio = (density(within, i) + goes_on[i] * density(beyond, i)) / all;
    ratios[i] = ratio > least_ratio ? ratio : least_ratio;
  }
}

void PathMoments::add(const EyePathLog::Contribution& contribution) {
  const auto& [c, densities, technique] = contribution;
  if (!(c > 0) || !std::isfinite(c)) return;
  const bool is_walk = technique == &TechniqueDensities::walk;
  if (is_walk && set != 0) return;  // the same eye path again
  if (set == 0) light += c;
  if (is_walk) by_walk += c;
  candidates_.ratios(densities, 0, ratios_);
  const std::size_t first_row = is_walk                                         ? walk
                                : technique == &TechniqueDensities::connections ? connections + 2 * set
                                : technique == &TechniqueDensities::media       ? media + 2 * set
                                                                                : merges + 2 * set;
  const double square = (is_walk ? 1 : 0.5) * sqr(static_cast<double>(c));
  const bool by_all = !densities.is_beyond;
  const std::span<const float> samples = candidates_.samples(technique), goes_on = candidates_.goes_on();
  const std::span<double> of_self = row(self), sum = row(first_row), squares = row(first_row + 1);
  for (std::size_t k = 0; k < of_self.size(); ++k) of_self[k] += square / static_cast<double>(ratios_[k]);
  for (std::size_t k = 0; k < ratios_.size(); ++k)
    ratios_[k] = samples[k] > 0 && (by_all || goes_on[k] > 0) ? c / ratios_[k] : 0.0f;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    const auto found = static_cast<double>(ratios_[k]);
    sum[k] += found;
    squares[k] += found * found;
  }
}

}  // namespace lanthorn
