// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Emitters of pbrt's quadrics.
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

/// Disk or ring at object-space height z, azimuth in [0, phi_max]; natural normal: the image of object-space +z.
struct DiskEmitter {
  Point centre{0};
  Vec3 axis_x{1, 0, 0}, axis_y{0, 1, 0};  ///< world-space images of the object's unit vectors
  Normal normal{0, 0, 1};
  float radius = 1, inner_radius = 0;  ///< object space
  float phi_max = 2 * pi;              ///< radians
  float area = 0;                      ///< m², world

  DiskEmitter() = default;
  DiskEmitter(const Transform& object_to_world, float height, float radius, float inner_radius = 0,
              float phi_max = 2 * pi);

  EmitterPoint sample_area(const Vec2& u) const;
  std::optional<Vec2> invert_sample_area(const Point& point) const;
  Bounds bounds() const;
  NormalCone normal_cone() const;

 private:
  bool is_whole() const { return inner_radius == 0 && phi_max > 2 * pi * (1 - 1e-6f); }
};

}  // namespace lanthorn
