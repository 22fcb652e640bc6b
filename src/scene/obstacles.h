// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "material/material_table.h"
#include "scene/geometry.h"
#include "scene/scene.h"

namespace lanthorn {

/// See `Scene::obstacles`. Interfaces of media are not obstacles, nor are matte shapes that emit: they do not block
/// their own light.
std::vector<Obstacle> find_obstacles(const Geometry& geometry, const MaterialTable& materials);

}  // namespace lanthorn
