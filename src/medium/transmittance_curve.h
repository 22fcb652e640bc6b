// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "medium/medium.h"

namespace lanthorn {

/// Transmittance from a segment's origin to every point of it: exact if there is a closed form, otherwise an unbiased
/// estimate at each point, by one ratio tracking for all of them.
class TransmittanceCurve {
 public:
  TransmittanceCurve(const Medium& medium, const Segment& segment, const Wavelengths& w, HashRng& rng);

  /// Transmittance from the origin to a finite distance (m).
  Spectrum to(float distance) const;

 private:
  struct Step {
    float distance;
    Spectrum transmittance;  ///< from this distance on
  };

  Spectrum extinction_;      ///< of the closed form, otherwise 0
  std::vector<Step> steps_;  ///< in order
};

}  // namespace lanthorn
