// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "math/tree_distribution.h"

namespace lanthorn {

/// Where light paths should start. Emission is drawn from four numbers, two for the position and two for the direction
/// (`sample_emission`), whatever the light is: a guide draws these four by a density of its own instead of evenly, and
/// the photon's flux is divided by it, so that no estimate changes in the mean.
struct EmissionGuide {
  struct OfLight {
    TreeDistribution numbers;
    float relevance = 1;  ///< photons of this light per watt, up to a factor common to all lights; > 0
  };
  std::vector<OfLight> lights;  ///< by index
};

}  // namespace lanthorn
