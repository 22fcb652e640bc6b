// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The second moments that a pixel would have if its light were found with other numbers of samples, from samples that
// are drawn with the numbers of a pilot (Grittmann, Yazici, Georgiev & Slusallek 2022, "Efficiency-aware multiple
// importance sampling for bidirectional rendering algorithms").
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "integrators/vcm/eye_path_log.h"
#include "math/vec.h"
#include "path/mis.h"

namespace lanthorn {

/// Numbers of samples per technique that a place on the film could use, as multiples of the pilot's numbers.
struct EffortCandidate {
  float light_paths = 1;  ///< of the pass
  float connections = 1;  ///< light paths that each eye vertex is connected to
  bool merges = true;     ///< on surfaces
  bool merges_in_media = true;
  bool sees = true;      ///< light paths are connected to the lens
  bool goes_on = true;   ///< eye paths go on after a lobe that is not delta (`Techniques::goes_on`)
  float merge_area = 1;  ///< area of merging discs over the pilot's: the radius depends on the number of light paths

  /// The technique's number of samples over the pilot's. Merging uses all light paths; on surfaces the number of
  /// photons also grows with the area of its discs.
  float samples(Technique technique) const {
    if (technique == &TechniqueDensities::walk) return 1;
    if (technique == &TechniqueDensities::connections) return light_paths > 0 ? connections : 0.0f;
    if (technique == &TechniqueDensities::merging) return merges ? merge_area * light_paths : 0.0f;
    if (technique == &TechniqueDensities::media && !merges_in_media) return 0;
    if (technique == &TechniqueDensities::lens && !sees) return 0;
    return light_paths;
  }
};

/// The technique's place in the list.
inline std::size_t index_of(Technique technique) {
  return static_cast<std::size_t>(std::ranges::find(all_techniques, technique) - all_techniques.begin());
}

/// A list of candidates in arrays, so that vector instructions judge several of them at a time.
class CandidateArrays {
 public:
  CandidateArrays() = default;
  explicit CandidateArrays(std::span<const EffortCandidate> candidates) {
    for (std::size_t t = 0; t < all_techniques.size(); ++t)
      for (const EffortCandidate& c : candidates) samples_[t].push_back(c.samples(all_techniques[t]));
    for (const EffortCandidate& c : candidates) goes_on_.push_back(c.goes_on ? 1.0f : 0.0f);
  }
  std::size_t size() const { return goes_on_.size(); }

  /// `EffortCandidate::samples` of all candidates.
  std::span<const float> samples(Technique technique) const { return samples_[index_of(technique)]; }
  /// `EffortCandidate::goes_on` of all candidates: 1 or 0.
  std::span<const float> goes_on() const { return goes_on_; }

  /// R of the candidates from `first` on: their density of all techniques together over the pilot's.
  void ratios(const TechniqueSum& s, std::size_t first, std::span<float> result) const;

 private:
  std::array<std::vector<float>, all_techniques.size()> samples_;
  std::vector<float> goes_on_;
};

/// Second moments of one eye path's light, one for each candidate, from two independent sets of light paths.
///
/// The path's light is X = Σ c_i, each c_i by some technique. With the balance heuristic, c = f / Σ n p. If a candidate
/// has R times the density Σ n p of the path that made c_i, and s times as many samples of the technique, its samples
/// have c_i / R and are s times as many. Hence E[Σ c²] is Σ s (c_i / R)². It is also Σ c_i² / R over all techniques of
/// the pilot, which counts paths that the candidate finds too rarely to be seen here.
///
/// Products of two contributions, (c_i / R_i)(c_j / R_j), are summed by the origin of both. The walk W does not depend
/// on light paths. For light paths, E[L | eye path]² is estimated by the product of the two sets, L_A L_B, and grows
/// with s². The products within a set, L_A² - Σ c_i², differ from that because samples share a light path and because
/// light paths avoid each other (stratification); the difference grows with s.
class PathMoments {
 public:
  explicit PathMoments(const CandidateArrays& candidates)
      : candidates_(candidates), ratios_(candidates.size()), sums_(candidates.size() * row_count) {}

  std::size_t set = 0;           ///< the set of light paths that the contribution comes from: 0 or 1
  float light = 0, by_walk = 0;  ///< X with the first set, and the part of it that needs no light path

  /// Adds a contribution c.
  void add(const EyePathLog::Contribution& c);
  /// Estimates for candidate k, without light that the lens sees.
  struct Estimate {
    double light;          ///< E[X]
    double second_moment;  ///< E[X²] of the contributions that the candidate finds here
    double of_eye_path;    ///< E[E[X | eye path]²]
    double squares;        ///< the part Σ s (c / R)² of E[X²]
    double all_squares;    ///< Σ c² / R
  };
  Estimate estimate(std::size_t k) const {
    const PathSum walk = path_sum(row_of(&TechniqueDensities::walk, 0), k);
    const double w = walk.sum;
    double a = 0, b = 0;  // light of the sets
    double squares = 0, within_sets = 0;
    for (const Technique t : all_techniques) {
      if (t == &TechniqueDensities::walk) continue;
      const auto samples = static_cast<double>(candidates_.samples(t)[k]);
      const PathSum of_a = path_sum(row_of(t, 0), k), of_b = path_sum(row_of(t, 1), k);
      a += samples * of_a.sum;
      b += samples * of_b.sum;
      squares += samples * (of_a.squares + of_b.squares) / 2;
      within_sets += samples * ((of_a.pairs() + of_b.pairs()) / 2 - of_a.sum * of_b.sum);
    }
    const double of_eye_path = w * w + w * (a + b) + a * b;
    return {w + (a + b) / 2, of_eye_path + squares + within_sets, of_eye_path, walk.squares + squares,
            sums_[self_row * candidates_.size() + k]};
  }

 private:
  struct PathSum {
    double sum, squares;
    // Products of two different samples.
    double pairs() const { return sqr(sum) - squares; }
  };
  // `sums_` has a row for each technique and set, with the sums of all candidates, one for their squares after it, and
  // one for `all_squares` at the end.
  static constexpr std::size_t self_row = 4 * all_techniques.size(), row_count = self_row + 1;
  static std::size_t row_of(Technique technique, std::size_t set) { return 4 * index_of(technique) + 2 * set; }

  PathSum path_sum(std::size_t row, std::size_t k) const {
    const std::size_t at = row * candidates_.size() + k;
    return {sums_[at], sums_[at + candidates_.size()]};
  }
  std::span<double> row(std::size_t number) {
    return std::span(sums_).subspan(number * candidates_.size(), candidates_.size());
  }

  const CandidateArrays& candidates_;
  std::vector<float> ratios_;  // scratch
  std::vector<double> sums_;
};

}  // namespace lanthorn
