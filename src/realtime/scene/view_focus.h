// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/view.h"
#include "lanthorn/vec.h"
#include "math/vec.h"
#include "scene/scene.h"

namespace lanthorn {

/// Where a view shows detail: around its eye; for parallel rays, around the median of the points that they see.
struct ViewFocus {
  Point centre{0};
  float distance = infinity;  ///< median distance of visible points from the centre, m; infinity: nothing is visible
};

/// Found by 64 rays through a view at rest, so that it is the same for all frames of the view.
ViewFocus focus_of(const Scene& scene, const View& view);

/// Radius of the visible region, m: the radius of the scene or, for a small object in a large place, four times its
/// distance.
float seen_radius(const Scene& scene, const View& view);

}  // namespace lanthorn
