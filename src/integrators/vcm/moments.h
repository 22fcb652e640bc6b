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

/// Numbers of samples by which a place on the film may find its light, as multiples of the pilot's.
struct EffortCandidate {
  float light_paths = 1;  ///< of the pass
  float connections = 1;  ///< light paths that each eye vertex is connected to
  bool merges = true;     ///< on surfaces
  bool merges_in_media = true;

  /// How many times the pilot's samples the technique has. Merging on surfaces and in media takes part in all light
  /// paths.
  float samples(float TechniqueSum::*technique) const {
    if (technique == &TechniqueSum::walk) return 1;
    if (technique == &TechniqueSum::connections) return light_paths > 0 ? connections : 0.0f;
    if (technique == &TechniqueSum::merging && !merges) return 0;
    if (technique == &TechniqueSum::media && !merges_in_media) return 0;
    return light_paths;
  }
  /// The densities of all techniques with these numbers.
  float all(const TechniqueSum& s) const {
    const float c = light_paths > 0 ? connections : 0.0f;
    return s.walk + light_paths * s.lens + c * s.connections +
           light_paths * ((merges ? s.merging : 0.0f) + (merges_in_media ? s.media : 0.0f));
  }
};

/// How often the eye path of a sample did what takes time.
struct EyeWork {
  std::uint32_t rays = 0, shadow_rays = 0, connections = 0, lookups = 0, merges = 0;
};

/// Second moments of one eye path's light, one for each candidate.
///
/// The path's light is X = Σ c_i, each c_i by some technique. With the balance heuristic, c = f / Σ n p. If a candidate
/// has R times the density Σ n p of the path that made c_i, and s times as many samples of the technique, its samples
/// have c_i / R and are s times as many. Hence E[Σ c²] is Σ c_i² / R. This sum runs over all techniques of the pilot,
/// so that it counts paths which the candidate would miss. The samples of one eye path are correlated: the product of
/// two of them has the expectation of (s_i c_i / R_i)(s_j c_j / R_j).
class PathMoments {
 public:
  explicit PathMoments(std::span<const EffortCandidate> candidates)
      : candidates_(candidates), sums_(candidates.size()) {}

  TechniqueSum weighed;  ///< of the contribution that comes next
  EyeWork work;
  float light = 0, by_walk = 0;  ///< X, and the part of it that needs no light path

  void add(float c, float TechniqueSum::*technique) {
    if (!(c > 0) || !std::isfinite(c)) return;
    light += c;
    if (technique == &TechniqueSum::walk) by_walk += c;
    const float all = weighed.all();
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      const EffortCandidate& candidate = candidates_[k];
      const float ratio = std::max(candidate.all(weighed) / all, least_ratio);
      const float x = candidate.samples(technique) * c / ratio;
      Sums& s = sums_[k];
      s.light += static_cast<double>(x);
      s.squares += sqr(static_cast<double>(x));
      s.self += sqr(static_cast<double>(c)) / static_cast<double>(ratio);
    }
  }
  /// An estimate of E[X] for candidate k, but for light that the lens sees.
  double light_of(std::size_t k) const { return sums_[k].light; }
  /// The estimate of E[X²] for candidate k.
  double second_moment(std::size_t k) const {
    const Sums& s = sums_[k];
    return s.light * s.light - s.squares + s.self;
  }

  static constexpr float least_ratio = 1e-6f;  ///< of paths that the candidate cannot find

 private:
  struct Sums {
    double light = 0, squares = 0, self = 0;
  };
  std::span<const EffortCandidate> candidates_;
  std::vector<Sums> sums_;
};

}  // namespace lanthorn
