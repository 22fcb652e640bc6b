// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <optional>

#include "lanthorn/transform.h"
#include "light/emitter_sample.h"

namespace lanthorn {

/// Sphere about the object-space origin, clipped to z in [z_min, z_max] and azimuth in [0, phi_max]; natural normal
/// outwards.
struct SphereEmitter {
  glm::mat3 linear{1.0f};  ///< object to world
  Point centre{0};
  float radius = 1, z_min = -1, z_max = 1;  ///< object space
  float phi_max = 2 * pi;                   ///< radians
  float area = 0;                           ///< m², world
  float max_stretch = 0;                    ///< bound of dA_world / dA_object; 0 if that is the same everywhere
  float world_radius = 0;                   ///< of a whole sphere under a similarity; 0 for every other shape

  SphereEmitter() = default;
  /// z_min and z_max are clamped to [-radius, radius].
  SphereEmitter(const Transform& object_to_world, float radius, float z_min = -infinity, float z_max = infinity,
                float phi_max = 2 * pi);

  EmitterPoint sample_area(const Vec2& u) const;
  /// Nullopt if stretched, and if whole and round, because `sample_towards` then draws only points that face `from`.
  std::optional<Vec2> invert_sample_area(const Point& point) const;
  Bounds bounds() const;
  NormalCone normal_cone() const;
  /// A whole round sphere seen from outside: uniform in the cone of directions. Otherwise by area.
  std::optional<EmitterDirection> sample_towards(const Point& from, const Vec2& u) const;
  float pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const;
};

}  // namespace lanthorn
