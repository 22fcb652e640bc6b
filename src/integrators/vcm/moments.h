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

#include "lanthorn/effort_report.h"
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
  float samples(float TechniqueDensities::*technique) const {
    if (technique == &TechniqueDensities::walk) return 1;
    if (technique == &TechniqueDensities::connections) return light_paths > 0 ? connections : 0.0f;
    if (technique == &TechniqueDensities::merging) return merges ? merge_area * light_paths : 0.0f;
    if (technique == &TechniqueDensities::media && !merges_in_media) return 0;
    if (technique == &TechniqueDensities::lens && !sees) return 0;
    return light_paths;
  }
};

/// A list of candidates in arrays, so that vector instructions judge several of them at a time.
class CandidateArrays {
 public:
  CandidateArrays() = default;
  explicit CandidateArrays(std::span<const EffortCandidate> candidates) {
    for (std::size_t t = 0; t < techniques.size(); ++t)
      for (const EffortCandidate& c : candidates) samples_[t].push_back(c.samples(techniques[t]));
    for (const EffortCandidate& c : candidates) goes_on_.push_back(c.goes_on ? 1.0f : 0.0f);
  }
  std::size_t size() const { return goes_on_.size(); }

  /// `EffortCandidate::samples` of all candidates.
  std::span<const float> samples(float TechniqueDensities::*technique) const {
    return samples_[static_cast<std::size_t>(std::ranges::find(techniques, technique) - techniques.begin())];
  }
  /// `EffortCandidate::goes_on` of all candidates: 1 or 0.
  std::span<const float> goes_on() const { return goes_on_; }

  /// R of the candidates from `first` on: their density of all techniques together over the pilot's.
  void ratios(const TechniqueSum& s, std::size_t first, std::span<float> result) const;

 private:
  static constexpr std::array techniques{&TechniqueDensities::walk, &TechniqueDensities::lens,
                                         &TechniqueDensities::connections, &TechniqueDensities::merging,
                                         &TechniqueDensities::media};

  std::array<std::vector<float>, techniques.size()> samples_;
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

  TechniqueSum weighed;          ///< of the contribution that comes next
  EyeWork work, short_work;      ///< with both sets; of the part that a short eye path does (`Techniques::goes_on`)
  std::size_t set = 0;           ///< the set of light paths that the contribution comes from: 0 or 1
  float light = 0, by_walk = 0;  ///< X with the first set, and the part of it that needs no light path

  /// `is_short`: a short eye path performs this operation, too.
  void count(double EyeWork::*what, bool is_short) {
    ++(work.*what);
    if (is_short) ++(short_work.*what);
  }
  /// Adds a contribution c by a technique, with the densities `weighed`.
  void add(float c, float TechniqueDensities::*technique);
  /// Estimates for candidate k, without light that the lens sees.
  struct Estimate {
    double light;          ///< E[X]
    double second_moment;  ///< E[X²] of the contributions that the candidate finds here
    double of_eye_path;    ///< E[E[X | eye path]²]
    double squares;        ///< the part Σ s (c / R)² of E[X²]
    double all_squares;    ///< Σ c² / R
  };
  Estimate estimate(std::size_t k) const {
    const auto samples = [&](float TechniqueDensities::*technique) {
      return static_cast<double>(candidates_.samples(technique)[k]);
    };
    const Sums s = sums(k);
    const double m = samples(&TechniqueDensities::connections), n = samples(&TechniqueDensities::merging),
                 v = samples(&TechniqueDensities::media);
    const double w = s.walk.sum;
    const auto light_of = [&](int i) { return m * s.connections[i].sum + n * s.merges[i].sum + v * s.media[i].sum; };
    const double a = light_of(0), b = light_of(1);
    const double of_eye_path = w * w + w * (a + b) + a * b;
    const auto within = [](const PathSum(&of)[2]) {
      return (of[0].pairs() + of[1].pairs()) / 2 - of[0].sum * of[1].sum;
    };
    const auto both = [](const PathSum(&of)[2]) { return (of[0].squares + of[1].squares) / 2; };
    const double of_light = m * both(s.connections) + n * both(s.merges) + v * both(s.media);
    const double second_moment =
        of_eye_path + of_light + m * within(s.connections) + n * within(s.merges) + v * within(s.media);
    return {w + (a + b) / 2, second_moment, of_eye_path, s.walk.squares + of_light, s.self};
  }

 private:
  struct PathSum {
    double sum, squares;
    // Products of two different samples.
    double pairs() const { return sqr(sum) - squares; }
  };
  struct Sums {
    PathSum walk, connections[2], merges[2], media[2];
    double self;
  };
  // `sums_` has a row for each number of Sums, with the sums of all candidates. Rows of PathSum:
  static constexpr std::size_t walk = 0, connections = 2, merges = 6, media = 10, self = 14, row_count = 15;

  double sum(std::size_t row, std::size_t k) const { return sums_[row * candidates_.size() + k]; }
  PathSum path_sum(std::size_t row, std::size_t k) const { return {sum(row, k), sum(row + 1, k)}; }
  Sums sums(std::size_t k) const {
    return {path_sum(walk, k),
            {path_sum(connections, k), path_sum(connections + 2, k)},
            {path_sum(merges, k), path_sum(merges + 2, k)},
            {path_sum(media, k), path_sum(media + 2, k)},
            sum(self, k)};
  }
  std::span<double> row(std::size_t number) {
    return std::span(sums_).subspan(number * candidates_.size(), candidates_.size());
  }

  const CandidateArrays& candidates_;
  std::vector<float> ratios_;  // scratch
  std::vector<double> sums_;
};

}  // namespace lanthorn
