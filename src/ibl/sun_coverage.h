// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The suns of an environment in a cube map that filters nothing.
#pragma once

#include "ibl/cube_map.h"
#include "ibl/environment.h"

namespace lanthorn {

/// Adds to each texel of the map the excess of each sun, times the share of the texel's solid angle that the sun
/// covers. So the flux of the suns is kept, and no texel becomes brighter than the texels of the image that it shows.
/// Does not close the seams.
void add_suns(const Environment& environment, CubeMap& map);

}  // namespace lanthorn
