// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Environments that need no file: their radiance is a formula.
#pragma once

#include <optional>
#include <string_view>

#include "lanthorn/image.h"
#include "math/vec.h"

namespace lanthorn {

/// Radiance of three soft lamps (key, fill and rim light) in a grey room. x points towards the camera, y to the right
/// of the picture, z upwards. A white wall that faces the camera has about radiance 1.
float studio_radiance(const Direction& d);

/// The environment of this name, as an equirectangular picture in the layout of `EnvironmentLayout`: y up. A white
/// floor has about radiance 1 in it. What is in front of a model, +z, is in front of the studio's camera; the sun
/// stands there on the left. nullopt for other names (`environment_names`).
std::optional<Image> own_environment(std::string_view name);

}  // namespace lanthorn
