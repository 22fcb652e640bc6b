// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Is told what an eye path finds and does. The pilot of `auto` is one; other renders have none.
class EyePathObserver {
 public:
  virtual ~EyePathObserver() = default;
  /// A contribution by a technique. `flux`: with its weight (`flux_of`); `densities`: those behind the weight.
  virtual void found(float flux, const TechniqueSum& densities, float TechniqueDensities::*technique) = 0;
  /// An operation. `is_short`: a short eye path performs it, too (`Techniques::goes_on`).
  virtual void did(double EyeWork::*operation, bool is_short) = 0;
};

}  // namespace lanthorn
