// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The second moments that a pixel would have if its light were found with other numbers of samples, from samples that
// are drawn with the numbers of a pilot (Grittmann, Yazici, Georgiev & Slusallek 2022, "Efficiency-aware multiple
// importance sampling for bidirectional rendering algorithms").
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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
  /// Sum of the densities of all techniques with these numbers of samples.
  float all(const TechniqueSum& s) const { return of(s.within) + (goes_on ? of(s.beyond) : 0.0f); }

 private:
  float of(const TechniqueDensities& s) const {
    const float c = light_paths > 0 ? connections : 0.0f;
    return s.walk + c * s.connections +
           light_paths *
               ((sees ? s.lens : 0.0f) + (merges ? merge_area * s.merging : 0.0f) + (merges_in_media ? s.media : 0.0f));
  }
};

/// Counts of the costly operations of eye paths.
struct EyeWork {
  double rays = 0, next_events = 0, connections = 0;
  double lookups = 0, merges = 0;              ///< on surfaces
  double media_lookups = 0, media_merges = 0;  ///< on flights and at scatterings

  void add(const EyeWork& other, double factor = 1) {
    rays += factor * other.rays;
    next_events += factor * other.next_events;
    connections += factor * other.connections;
    lookups += factor * other.lookups;
    merges += factor * other.merges;
    media_lookups += factor * other.media_lookups;
    media_merges += factor * other.media_merges;
  }
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
  explicit PathMoments(std::span<const EffortCandidate> candidates)
      : candidates_(candidates), sums_(candidates.size()) {}

  TechniqueSum weighed;          ///< of the contribution that comes next
  EyeWork work, short_work;      ///< with both sets; of the part that a short eye path does (`Techniques::goes_on`)
  int set = 0;                   ///< the set of light paths that the contribution comes from: 0 or 1
  float light = 0, by_walk = 0;  ///< X with the first set, and the part of it that needs no light path

  /// `is_short`: a short eye path performs this operation, too.
  void count(double EyeWork::*what, bool is_short) {
    ++(work.*what);
    if (is_short) ++(short_work.*what);
  }
  void add(float c, float TechniqueDensities::*technique) {
    if (!(c > 0) || !std::isfinite(c)) return;
    const bool is_walk = technique == &TechniqueDensities::walk;
    if (is_walk && set != 0) return;  // the same eye path again
    if (set == 0) light += c;
    if (is_walk) by_walk += c;
    const float all = weighed.all();
    const double share = is_walk ? 1 : 0.5;
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      const EffortCandidate& candidate = candidates_[k];
      const float ratio = std::max(candidate.all(weighed) / all, least_ratio);
      Sums& s = sums_[k];
      s.self += share * sqr(static_cast<double>(c)) / static_cast<double>(ratio);
      if (candidate.samples(technique) == 0 || (weighed.is_beyond && !candidate.goes_on)) continue;
      PathSum& sum = is_walk                                         ? s.walk
                     : technique == &TechniqueDensities::connections ? s.connections[set]
                     : technique == &TechniqueDensities::media       ? s.media[set]
                                                                     : s.merges[set];
      sum.add(static_cast<double>(c / ratio));
    }
  }
  /// Estimates for candidate k, without light that the lens sees.
  struct Estimate {
    double light;          ///< E[X]
    double second_moment;  ///< E[X²] of the contributions that the candidate finds here
    double of_eye_path;    ///< E[E[X | eye path]²]
    double squares;        ///< the part Σ s (c / R)² of E[X²]
    double all_squares;    ///< Σ c² / R
  };
  Estimate estimate(std::size_t k) const {
    const Sums& s = sums_[k];
    const EffortCandidate& candidate = candidates_[k];
    const auto samples = [&](float TechniqueDensities::*technique) {
      return static_cast<double>(candidate.samples(technique));
    };
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

  static constexpr float least_ratio = 1e-6f;  ///< stands in for 0: the candidate cannot find the path

 private:
  struct PathSum {
    double sum = 0, squares = 0;
    void add(double x) {
      sum += x;
      squares += sqr(x);
    }
    // Products of two different samples.
    double pairs() const { return sqr(sum) - squares; }
  };
  struct Sums {
    PathSum walk, connections[2], merges[2], media[2];
    double self = 0;
  };
  std::span<const EffortCandidate> candidates_;
  std::vector<Sums> sums_;
};

}  // namespace lanthorn
