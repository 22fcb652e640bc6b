// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What `bake_ibl` filters, and into which maps: the same for the CPU and for the GPU
// (realtime/techniques/splitsum/environment_baker.h).
#pragma once

#include <vector>

#include "ibl/cube_map.h"
#include "ibl/environment.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

struct LevelPlan {
  int size = 1;
  float roughness = 0, alpha = 0;
  int samples = 0;  ///< of the lobe; 0: mirrors
};
/// Levels of the specular map, from the mirrors on.
std::vector<LevelPlan> specular_levels(const IblSettings& settings);

/// The environment without its suns, as fine as the settings need it.
CubePyramid source_of(const Environment& environment, const IblSettings& settings);

/// All light of the environment as points, as fine as the cosine needs them.
std::vector<PointFlux> irradiance_points(const CubePyramid& source, const Environment& environment);

}  // namespace lanthorn
