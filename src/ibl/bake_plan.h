// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What `bake_ibl` filters, and into which maps; shared by the CPU and the GPU baker
// (realtime/techniques/splitsum/environment_maps.h).
#pragma once

#include <vector>

#include "ibl/cube_map.h"
#include "ibl/environment.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

/// Roughness of the level at x = level / last level; and the inverse.
float level_roughness(float x, RoughnessMapping mapping);
float level_of_roughness(float roughness, RoughnessMapping mapping);

struct LevelPlan {
  int size = 1;
  float roughness = 0, alpha = 0;
  int samples = 0;  ///< of the lobe; 0: mirror
};
/// Levels of the specular map, starting with the mirror.
std::vector<LevelPlan> specular_levels(const IblSettings& settings);

/// The environment without its suns, at the resolution that the settings need.
CubePyramid source_of(const Environment& environment, const IblSettings& settings);

/// All light of the environment as points, at the resolution that the cosine kernel needs.
std::vector<PointFlux> irradiance_points(const CubePyramid& source, const Environment& environment);

}  // namespace lanthorn
