// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "light/emitter_sample.h"

namespace lanthorn {

/// Triangle in world space; its natural normal is along (p1 - p0) x (p2 - p0).
struct TriangleEmitter {
  std::array<Point, 3> p{};
  Normal normal{0};  ///< zero if the triangle has no area
  float area = 0;    ///< m²

  TriangleEmitter() = default;
  TriangleEmitter(const Point& p0, const Point& p1, const Point& p2);

  EmitterPoint sample_area(const Vec2& u) const;
  std::optional<Vec2> invert_sample_area(const Point& point) const;
  Bounds bounds() const;
  NormalCone normal_cone() const;
  /// Uniform in the triangle's solid angle (Arvo 1995, in the form of Peters 2021, §3), or by area if the solid angle
  /// is too small or too large for that.
  std::optional<EmitterDirection> sample_towards(const Point& from, const Vec2& u) const;
  float pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const;
};

}  // namespace lanthorn
