// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Determines which surfaces of a model its own lights illuminate.
#pragma once

#include <vector>

#include "lanthorn/scene_description.h"
#include "staging/model_views.h"

namespace lanthorn {

/// Luminance of the light's untextured emission.
float radiance_of(const description::AreaLight& light);
/// True if it illuminates other surfaces: its emission is not textured and has a component above radiance 1.
bool shines(const description::AreaLight& light);

/// The sides of the samples that receive direct light from the scene's point, spot and distant lights and from emitters
/// that shine: at least a twentieth of the typical irradiance. Clear surfaces do not block light. Empty, which means
/// all sides, if no sample is lit or if there are lights of other kinds.
std::vector<LitSides> lit_sides(const SceneDescription& scene, const ModelSamples& model);
/// The median of the irradiance on the brighter sides of the samples that this light reaches; 0 where `lit_sides` is
/// empty.
float typical_irradiance(const SceneDescription& scene, const ModelSamples& model);

}  // namespace lanthorn
