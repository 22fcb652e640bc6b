// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Panes one behind another, such as the two panes of double glazing, reflect light to and fro between each other. Rays
// pass panes straight, so this light is added to the light that passes, and to the light that is reflected.
#pragma once

#include <memory>
#include <span>

#include "scene/geometry.h"

namespace lanthorn {

/// Joins the panes among the shapes, which are in one space, to windows: fills `ShapeStore::window`. Panes belong to
/// one window if they are flat, parallel and of one size, and closer to each other than a tenth of their extent.
void join_windows(std::span<const std::unique_ptr<ShapeStore>> shapes);

/// Probability that a ray of this direction, of any length, which has passed all faces of the window before `hit`, is
/// reflected by the pane's face there. A ray passes all faces of a window, with reflectances R_i, with probability
/// 1 / (1 + Σ R_i / (1 - R_i)): the sum over all ways on which light is reflected to and fro between the faces, without
/// interference. The rest is reflected to where the ray comes from, so that a ray which starts on a face of the window,
/// reflected, passes all others. Light from things between two panes is reflected by the panes on its way alone.
float reflectance_of_pane(const ShapeStore& pane, const Point& origin, const Vec3& direction,
                          const SurfaceGeometry& hit);

}  // namespace lanthorn
