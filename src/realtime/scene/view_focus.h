// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/view.h"
#include "lanthorn/vec.h"
#include "math/vec.h"
#include "scene/scene.h"

namespace lanthorn {

/// Where a view shows detail: around its eye, or, of parallel rays, around the median of what they see.
struct ViewFocus {
  Point centre{0};
  float distance = infinity;  ///< median distance of what is seen from the centre, m; infinity: nothing is seen
};

/// By 64 rays through a view at rest, so that it is the same for all of its frames.
ViewFocus focus_of(const Scene& scene, const View& view);

/// Radius of what is seen, m: that of the scene, or, of a small thing in a large place, four times the distance.
float seen_radius(const Scene& scene, const View& view);

}  // namespace lanthorn
