// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Media inside materials: subsurface scattering.
#pragma once

#include "medium/medium.h"
#include "scene/scene.h"

namespace lanthorn {

struct SceneData;

/// True if the medium is the interior of a material, such as skin or wax.
bool is_under_surface(const Scene& scene, MediumId medium);

/// Largest number of vertices under surfaces that a walk may have; 0 if no medium is under a surface.
int most_under_surface(const Scene& scene);

/// Number of scatterings after which a thousandth of the light is left in a medium of this albedo. At least 64; at most
/// 4096, for media that absorb nothing.
int scatterings_until_dark(float albedo);

/// Sets the parts of `data` that say which media are under surfaces. Needs its media.
void find_media_under_surfaces(SceneData& data);

}  // namespace lanthorn
