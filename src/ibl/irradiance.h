// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ibl/cube_map.h"
#include "ibl/environment.h"

namespace lanthorn {

/// All light of the environment as points: the texels of a map, each with its solid angle as the fourth component of
/// its flux, and the suns, without one. A kernel's sums over them are normalised by dividing by the sum of the fourth
/// component: a white environment gives 1.
std::vector<PointFlux> points_of(const CubeMap& map, const Environment& environment);

/// (1/pi) ∫ L cos dω for all normals, by a sum over all points.
CubeMap irradiance_map(const std::vector<PointFlux>& points, int size);

}  // namespace lanthorn
