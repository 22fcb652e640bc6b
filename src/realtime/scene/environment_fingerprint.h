// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/scene.h"

namespace lanthorn {

/// Radiance from directions all around, and from one direction of each light, by which environments are told apart:
/// edits change their strength or colour.
std::vector<Vec3> environment_fingerprint(const Scene& scene);

}  // namespace lanthorn
