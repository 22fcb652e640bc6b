// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Turns described media into Medium values.
#pragma once

#include <vector>

#include "lanthorn/scene_description.h"
#include "medium/medium.h"
#include "texture/spectrum_store.h"

namespace lanthorn {

/// All media of the scene, in the description's order. Throws Error if there are more media than ids.
std::vector<Medium> make_media(const SceneDescription& description, SpectrumStore& spectra);

}  // namespace lanthorn
