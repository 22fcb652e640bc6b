// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A pbrt file with another camera and edited lights and objects.
#pragma once

#include <string>
#include <string_view>

#include "lanthorn/scene.h"
#include "viewer/camera_motion.h"

namespace lanthorn {

/// The text of a pbrt file with the camera in this place and with edited lights, area lights and instances; everything
/// else stays letter by letter. `scene`: the description that was read from it. Throws Error if the file has no camera,
/// or if an edited part is described in another file that it includes.
std::string edited_pbrt(std::string_view text, const SceneDescription& scene, const CameraPose& camera,
                        const SceneDescription& edited);

}  // namespace lanthorn
