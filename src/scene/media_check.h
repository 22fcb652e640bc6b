// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "camera/view.h"
#include "scene/scene.h"

namespace lanthorn {

/// Warns of contradictory media: rays that travel in one medium and arrive where the scene claims another. The result
/// for such rays depends on their path, so integrators disagree. Follows straight rays through glass and interfaces,
/// from the camera and from the surfaces it sees on to the lights; of lights, those that are surfaces may lack the
/// medium around them (others: medium_around.h). What opaque surfaces claim does not count: rays stay in their medium
/// there. A few rays that slip between touching shapes do not count. One warning for each kind, at its location in the
/// scene file.
std::vector<description::Warning> media_warnings(const Scene& scene, const View& view);

}  // namespace lanthorn
