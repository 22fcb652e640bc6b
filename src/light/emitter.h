// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Geometry of emitting surfaces as self-contained values. Every emitter draws its points uniformly by world-space area,
// whatever the transform, so that photons of a diffuse light carry equal flux and the density is 1 / area everywhere.
// Normals are the shape's natural ones, before orientation: AreaLight flips them.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <optional>
#include <variant>

#include "math/transform.h"
#include "math/vec.h"

namespace lanthorn {

/// A point of an emitter drawn uniformly by area; its density is 1 / area.
struct EmitterPoint {
  Point point{0};
  Normal normal{0, 0, 1};  ///< natural geometric normal, unit
};

/// A point of an emitter drawn for, and seen from, a receiving point.
struct EmitterDirection {
  Point point{0};
  Normal normal{0, 0, 1};  ///< natural geometric normal, unit
  Direction wi{0, 0, 1};   ///< from the receiving point to the emitter
  float distance = 0;      ///< metres
  float pdf = 0;           ///< per solid angle at the receiving point
};

/// A cone that holds all natural normals of an emitter.
struct NormalCone {
  Direction axis{0, 0, 1};
  float cos = -1;  ///< cosine of the half angle; -1: any normal
};

/// Triangle in world space; its natural normal is along (p1 - p0) x (p2 - p0).
struct TriangleEmitter {
  std::array<Point, 3> p{};
  Normal normal{0};  ///< zero if the triangle has no area
  float area = 0;    ///< m²

  TriangleEmitter() = default;
  TriangleEmitter(const Point& p0, const Point& p1, const Point& p2);

  EmitterPoint sample_area(const Vec2& u) const;
  /// Uniform in the solid angle of the triangle (Arvo 1995; in the form of Peters 2021, §3), or by area where that
  /// solid angle is too small or too large for it.
  std::optional<EmitterDirection> sample_towards(const Point& from, const Vec2& u) const;
  float pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const;
};

/// Bilinear patch in world space, corners p00, p10, p01, p11; its natural normal is along dp/du x dp/dv.
struct PatchEmitter {
  Point p00{0}, p10{0}, p01{0}, p11{0};
  float area = 0;  ///< m²

  PatchEmitter() = default;
  PatchEmitter(const Point& p00, const Point& p10, const Point& p01, const Point& p11);

  EmitterPoint sample_area(const Vec2& u) const;
};

/// Sphere about the object-space origin, cut to z in [z_min, z_max] and azimuth in [0, phi_max]; natural normal
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
  /// z_min and z_max are clamped to the radius.
  SphereEmitter(const Transform& object_to_world, float radius, float z_min = -infinity, float z_max = infinity,
                float phi_max = 2 * pi);

  EmitterPoint sample_area(const Vec2& u) const;
  /// Uniform in the cone of directions for a whole round sphere seen from outside; by area otherwise.
  std::optional<EmitterDirection> sample_towards(const Point& from, const Vec2& u) const;
  float pdf_towards(const Point& from, const Point& hit, const Normal& normal_at_hit) const;
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
};

using EmitterShape = std::variant<TriangleEmitter, PatchEmitter, SphereEmitter, DiskEmitter, CylinderEmitter>;

/// World-space area, m².
float area(const EmitterShape& shape);
/// A point uniform by area. The shape's area must not be 0.
EmitterPoint sample_area(const EmitterShape& shape, const Vec2& u);
/// A point for next-event estimation from `from`: by solid angle where that pays, by area otherwise. Empty where the
/// density is not finite or the emitter is seen edge-on. Points that face away are not left out.
std::optional<EmitterDirection> sample_towards(const EmitterShape& shape, const Point& from, const Vec2& u);
/// Density per solid angle of `sample_towards` for the point `hit` with geometric normal `normal` (of either side).
float pdf_towards(const EmitterShape& shape, const Point& from, const Point& hit, const Normal& normal);
/// A box around the emitter, world space.
Bounds bounds(const EmitterShape& shape);
/// A cone around the emitter's natural normals.
NormalCone normal_cone(const EmitterShape& shape);

}  // namespace lanthorn
