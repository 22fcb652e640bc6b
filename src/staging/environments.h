// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Built-in environments, whose radiance is given by formulas, and the implementation of `replace_environment`
// (lanthorn/scene.h), by which several scenes can share a picture.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "lanthorn/image.h"
#include "lanthorn/scene_description.h"
#include "math/vec.h"

namespace lanthorn {

struct EnvironmentPicture {
  std::shared_ptr<const description::SphericalTexels> texels;
  std::optional<description::File> file;  ///< source of the picture, if it is a file
};
/// Throws Error if the file cannot be read, or has an unsupported shape or too many pixels.
EnvironmentPicture read_environment_picture(const EnvironmentChoice& choice, std::uint64_t max_pixels);
/// `choice` has a source, and `picture` was read from it.
void replace_environment(SceneDescription& scene, const EnvironmentChoice& choice, const EnvironmentPicture& picture);

/// Radiance of three soft lights (key, fill and rim light) in a grey room. x points towards the camera, y to the right
/// of the picture, z up. A white wall that faces the camera has about radiance 1.
float studio_radiance(const Direction& d);

/// The built-in environment of this name, as an equirectangular picture in the layout of `EnvironmentLayout`: y up. It
/// gives a white floor about radiance 1. The front of a model, +z, faces the studio's camera; the sun stands in front
/// of the model, on the left. nullopt for other names (`environment_names`).
std::optional<Image> own_environment(std::string_view name);

}  // namespace lanthorn
