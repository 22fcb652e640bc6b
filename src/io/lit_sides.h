// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Which surfaces of a model its own lights reach.
#pragma once

#include <vector>

#include "io/model_views.h"
#include "lanthorn/scene_description.h"

namespace lanthorn {

/// Luminance of its emission where no texture varies it.
float radiance_of(const description::AreaLight& light);
/// True if its emission does more than glow: if it is the same everywhere and has a component above radiance 1.
bool shines(const description::AreaLight& light);

/// The sides of the samples that get direct light from the scene's point, spot and distant lights and from surfaces
/// that shine: at least a twentieth of the typical irradiance. Clear surfaces do not hide lights. Empty, which stands
/// for all sides, if nothing is reached or if there are lights of other kinds.
std::vector<LitSides> lit_sides(const SceneDescription& scene, const ModelSamples& model);

}  // namespace lanthorn
