// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/geometry.h"
#include "scene/material.h"
#include "scene/scene.h"

namespace lanthorn {

/// See `Scene::obstacles`. Borders of media are none, and matte shapes that emit are none to the light that they emit.
std::vector<Obstacle> find_obstacles(const Geometry& geometry, const MaterialTable& materials);

}  // namespace lanthorn
