// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "camera/view.h"
#include "scene/scene.h"

namespace lanthorn {

/// Warns of contradictory media: rays that travel in one medium and arrive where the scene declares another. The result
/// for such rays depends on their path, so integrators disagree. Follows straight rays through glass and interfaces,
/// from the camera, and from the surfaces that it sees on to the lights. Among lights, only surfaces may lack the
/// medium around them (for other lights see medium_around.h). Media that opaque surfaces declare do not count, because
/// rays stay in their own medium there; nor do a few rays that slip between touching shapes. One warning for each kind,
/// at its location in the scene file.
std::vector<description::Warning> media_warnings(const Scene& scene, const View& view);

}  // namespace lanthorn
