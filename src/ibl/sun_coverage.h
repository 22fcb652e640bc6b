// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Adds the suns of an environment to an unfiltered cube map.
#pragma once

#include "ibl/cube_map.h"
#include "ibl/environment.h"

namespace lanthorn {

/// Adds to each texel of the map the excess of each sun, times the fraction of the texel's solid angle that the sun
/// covers. This preserves the suns' flux, and no texel becomes brighter than the image texels that it shows. Does not
/// close the seams.
void add_suns(const Environment& environment, CubeMap& map);

}  // namespace lanthorn
