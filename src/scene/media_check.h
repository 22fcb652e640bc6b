// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "camera/view.h"
#include "scene/scene.h"

namespace lanthorn {

/// Warns of media that contradict each other: rays that come in one medium to where the scene says that another one is.
/// What such rays see then depends on the way that they went, so that integrators disagree. Follows straight rays
/// through glass and interfaces, from the camera and from what it sees on to the lights. A few rays that slip between
/// shapes that touch do not count. One warning for each kind, at its place in the scene file.
std::vector<description::Warning> media_warnings(const Scene& scene, const View& view);

}  // namespace lanthorn
