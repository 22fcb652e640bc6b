// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/emitter_sample.h"

namespace lanthorn {

/// Plane parallelogram in world space with the points p00 + u a + v b for u, v in [0,1]; its natural normal is along a
/// x b. It replaces a pair of triangles, so that both are one light: one choice, one sample, one density.
struct ParallelogramEmitter {
  Point p00{0};
  Vec3 a{0}, b{0};
  Normal normal{0};  ///< zero if it has no area
  float area = 0;    ///< m²

  ParallelogramEmitter() = default;
  ParallelogramEmitter(const Point& p00, const Point& p10, const Point& p01);

  EmitterPoint sample_area(const Vec2& u) const;
  std::optional<Vec2> invert_sample_area(const Point& point) const;
  Bounds bounds() const;
  NormalCone normal_cone() const;
  /// Uniform in the solid angle, as two spherical triangles, or by area if the solid angle is too small or too large
  /// for that.
  std::optional<EmitterDirection> sample_towards(const Point& from, const Vec2& u) const;
  float pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const;
};

}  // namespace lanthorn
