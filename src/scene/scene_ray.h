// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "lanthorn/rays.h"
#include "math/ray.h"
#include "scene/scene.h"

namespace lanthorn {

/// The ray in the coordinates of the scene, with a unit direction, when the shutter opens. Throws Error, naming
/// `index`, unless all its numbers are finite and its direction is not 0.
Ray ray_in_scene(const Scene& scene, const SceneRay& ray, std::size_t index);

}  // namespace lanthorn
