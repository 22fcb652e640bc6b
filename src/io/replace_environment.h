// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Implements `replace_environment` (lanthorn/scene.h) so that several scenes can share a picture.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "lanthorn/scene_description.h"

namespace lanthorn {

struct EnvironmentPicture {
  std::shared_ptr<const description::SphericalTexels> texels;
  std::optional<description::File> file;  ///< source of the picture, if it is a file
};
/// Throws Error if the file cannot be read, or has an unsupported shape or too many pixels.
EnvironmentPicture read_environment_picture(const EnvironmentChoice& choice, std::uint64_t max_pixels);
/// `choice` has a source, and `picture` was read from it.
void replace_environment(SceneDescription& scene, const EnvironmentChoice& choice, const EnvironmentPicture& picture);

}  // namespace lanthorn
