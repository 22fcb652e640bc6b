// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/emitter_sample.h"

namespace lanthorn {

/// Bilinear patch in world space with corners p00, p10, p01, p11 that is not a plane parallelogram; its natural normal
/// is along dp/du x dp/dv.
struct PatchEmitter {
  Point p00{0}, p10{0}, p01{0}, p11{0};
  float area = 0;  ///< m²

  PatchEmitter() = default;
  PatchEmitter(const Point& p00, const Point& p10, const Point& p01, const Point& p11);

  EmitterPoint sample_area(const Vec2& u) const;
  /// Nullopt if it is not flat: some numbers are then rejected.
  std::optional<Vec2> invert_sample_area(const Point& point) const;
  Bounds bounds() const;
  NormalCone normal_cone() const;
};

}  // namespace lanthorn
