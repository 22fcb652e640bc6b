// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "math/tree_distribution.h"

namespace lanthorn {

/// Guided emission of light paths. Every light samples its emission from four numbers, two for the position and two for
/// the direction (`sample_emission`). A guide draws these four from a learned density instead of uniformly and divides
/// the photon's flux by that density, so the estimators stay unbiased.
struct EmissionGuide {
  struct OfLight {
    TreeDistribution numbers;
    float relevance = 1;  ///< photons of this light per watt, up to a factor common to all lights; > 0
  };
  std::vector<OfLight> lights;  ///< by index of the light
};

}  // namespace lanthorn
