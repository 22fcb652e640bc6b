// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The default camera and light of model files that have none.
#pragma once

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// A perspective camera (40 degrees) that sees all of the scene's triangle meshes from the front, +z, and from 15
/// degrees above, with +y up; the film must have its size already. A warning says so.
void add_default_camera(SceneDescription& scene);

/// An infinite light of radiance 1 from everywhere. A warning says so.
void add_default_environment(SceneDescription& scene);

}  // namespace lanthorn
