// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The view of a camera, or from a light, in the form that a rasteriser needs. Also finds where a view
// shows detail.
#pragma once

#include "camera/view.h"
#include "lanthorn/vec.h"
#include "math/vec.h"
#include "scene/scene.h"

namespace lanthorn {

/// Rays of a rectangular window: from `eye` through corner + x right + y down at distance 1 along `axis`, x and y in
/// [0,1]; or parallel ones along `axis`, from the points corner + x right + y down.
struct WindowRays {
  bool parallel = false;
  Point eye{0};
  Vec3 corner{0}, right{1, 0, 0}, down{0, 1, 0};
  Direction axis{0, 0, 1};
};

/// World to OpenGL's clip space with depths in [0,1], 1 nearest (glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE),
/// GL_GREATER). The first row of the window is the lowest in OpenGL, so that rows lie in memory from the upper one on.
/// Nothing nearer than `near` metres is drawn, nor, of parallel rays, farther than `far`.
Mat4 clip_matrix(const WindowRays& rays, float near, float far);

/// The rays of a view's window through points of its pixels that are off their centres by `offset`, for a point of the
/// lens. Throws Error for cameras whose rays are not of this kind (spherical, realistic).
WindowRays window_rays(const View& view, const Vec2& offset, const Vec2& u_lens, float time);

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
