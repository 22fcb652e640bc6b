// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <optional>

#include "lanthorn/transform.h"
#include "light/emitter_sample.h"

namespace lanthorn {

/// Open cylinder about the object-space z axis; natural normal outwards.
struct CylinderEmitter {
  glm::mat3 linear{1.0f};  ///< object to world
  Point origin{0};
  float radius = 1, z_min = -1, z_max = 1;  ///< object space
  float phi_max = 2 * pi;                   ///< radians
  float area = 0;                           ///< m², world
  float max_stretch = 0;                    ///< bound of dA_world / dA_object; 0 if that is the same everywhere

  CylinderEmitter() = default;
  CylinderEmitter(const Transform& object_to_world, float radius, float z_min, float z_max, float phi_max = 2 * pi);

  EmitterPoint sample_area(const Vec2& u) const;
  /// Nullopt if stretched.
  std::optional<Vec2> invert_sample_area(const Point& point) const;
  Bounds bounds() const;
  NormalCone normal_cone() const;
};

}  // namespace lanthorn
