// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// From described media to Medium values.
#pragma once

#include <vector>

#include "description/scene_description.h"
#include "medium/medium.h"
#include "texture/spectrum_store.h"

namespace lanthorn {

/// All media of the scene in the description's order. Throws Error if there are more than ids for them.
std::vector<Medium> make_media(const SceneDescription& description, SpectrumStore& spectra);

}  // namespace lanthorn
