// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Media that emit, as lights.
#pragma once

#include "scene/scene_data.h"

namespace lanthorn {

/// True if the medium is around the ray's origin: asks the first surface along the ray that bounds media.
bool lies_in(const SceneData& scene, MediumId medium, const Ray& ray);

/// Makes a light of each medium that emits, and puts them behind all others, in place of those that are there already.
/// Not of media that have no end, or that no surface bounds: eye paths alone find these (`has_unlit_glow`). `time`: at
/// which moving surfaces bound media.
void make_volume_lights(SceneData& scene, float time);

}  // namespace lanthorn
