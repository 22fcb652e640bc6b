// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// `replace_environment` (lanthorn/scene.h) for several scenes by one picture.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "lanthorn/scene_description.h"

namespace lanthorn {

struct EnvironmentPicture {
  std::shared_ptr<const description::SphericalTexels> texels;
  std::optional<description::File> file;  ///< that it was read from
};
/// Throws Error if the file cannot be read, or has another shape or more pixels.
EnvironmentPicture read_environment_picture(const EnvironmentChoice& choice, std::uint64_t max_pixels);
/// `choice` has a source, which `picture` is of.
void replace_environment(SceneDescription& scene, const EnvironmentChoice& choice, const EnvironmentPicture& picture);

}  // namespace lanthorn
