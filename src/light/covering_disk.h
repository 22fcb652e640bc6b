// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The disk that has the radius of the scene's bounding sphere, faces a far light and lies in front of the scene on that
// side. Photons of far lights start there.
#pragma once

#include "light/sample.h"
#include "math/frame.h"
#include "math/sampling.h"

namespace lanthorn {

/// Area of the disk, m².
inline float covering_disk_area(const BoundingSphere& scene) { return pi * scene.radius * scene.radius; }
/// A point of the disk that faces `towards`. Uniform; density 1 / area.
inline Point sample_covering_disk(const BoundingSphere& scene, const Direction& towards, const Vec2& u) {
  const Vec2 d = sample_concentric_disk(u);
  return scene.centre + scene.radius * Frame(towards).to_world({d.x, d.y, 1});
}
/// Inverse of `sample_covering_disk`, for any point of the line through the disk towards `towards`.
inline Vec2 invert_covering_disk(const BoundingSphere& scene, const Direction& towards, const Point& p) {
  const Vec3 local = Frame(towards).to_local(p - scene.centre) / scene.radius;
  return invert_concentric_disk({local.x, local.y});
}

}  // namespace lanthorn
