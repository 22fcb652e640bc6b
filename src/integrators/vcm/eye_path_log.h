// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "path/mis.h"

namespace lanthorn {

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

/// What an eye path finds and does, for the pilot of `auto`; other renders keep none.
struct EyePathLog {
  struct Contribution {
    float flux;              ///< with its weight (`flux_of`)
    TechniqueSum densities;  ///< behind the weight
    Technique technique;
  };
  std::vector<Contribution> found;
  EyeWork work, short_work;  ///< `short_work`: of these, what a short eye path does, too (`Techniques::goes_on`)

  void count(double EyeWork::*operation, bool is_short) {
    ++(work.*operation);
    if (is_short) ++(short_work.*operation);
  }
};

}  // namespace lanthorn
