// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The loops over candidates run for each contribution. They are plain, so that compilers make vector instructions of
// them.
#include "integrators/auto/moments.h"

#include <array>
#include <cmath>
#include <utility>

namespace lanthorn {

namespace {

constexpr auto numbers_of_techniques = std::make_index_sequence<all_techniques.size()>();

// Density of a candidate's techniques together. `samples`: of each technique, by candidate.
template <std::size_t... t>
float density_of(const TechniqueDensities& pilot, const std::array<const float*, sizeof...(t)>& samples,
                 std::size_t candidate, std::index_sequence<t...>) {
  return (... + (samples[t][candidate] * pilot.*all_techniques[t]));
}

}  // namespace

void CandidateArrays::ratios(const TechniqueSum& s, std::size_t first, std::span<float> result) const {
  constexpr float least_ratio = 1e-6f;  // stands in for 0: the candidate cannot find the path
  std::array<const float*, all_techniques.size()> samples{};
  for (std::size_t t = 0; t < samples.size(); ++t) samples[t] = samples_[t].data() + first;
  const float* const goes_on = goes_on_.data() + first;
  float* const ratios = result.data();
  const TechniqueDensities within = s.within, beyond = s.beyond;
  const float all = s.all();
  for (std::size_t i = 0, count = result.size(); i < count; ++i) {
    const float of_within = density_of(within, samples, i, numbers_of_techniques);
    const float ratio = (of_within + goes_on[i] * density_of(beyond, samples, i, numbers_of_techniques)) / all;
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
  const double square = (is_walk ? 1 : 0.5) * sqr(static_cast<double>(c));
  const bool by_all = !densities.is_beyond;
  const std::span<const float> samples = candidates_.samples(technique), goes_on = candidates_.goes_on();
  const std::size_t first_row = row_of(technique, set);
  const std::span<double> of_self = row(self_row), sum = row(first_row), squares = row(first_row + 1);
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
