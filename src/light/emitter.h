// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Geometry of emitting surfaces as self-contained values. Every emitter samples its points uniformly by world-space
// area, whatever the transform: the density is 1 / area, and photons of a diffuse light carry equal flux. Normals are
// the shape's natural ones, before orientation; AreaLight flips them.
#pragma once

#include <array>
#include <concepts>
#include <glm/mat3x3.hpp>
#include <optional>
#include <variant>

#include "lanthorn/transform.h"
#include "light/sample.h"
#include "math/vec.h"

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

/// Requirements on a light's shape. To add a shape: declare it above, define it in the source of its family, and
/// add its name to `EmitterShape`. It may also have `sample_towards` and `pdf_towards` like the functions below;
/// otherwise points are sampled by area.
template <class Shape>
concept Emitter = requires(const Shape& shape, const Vec2& u) {
  { shape.area } -> std::convertible_to<float>;  // world space, m²
  { shape.sample_area(u) } -> std::same_as<EmitterPoint>;
  { shape.bounds() } -> std::same_as<Bounds>;  // world space
  { shape.normal_cone() } -> std::same_as<NormalCone>;
};

using EmitterShape =
    std::variant<TriangleEmitter, ParallelogramEmitter, PatchEmitter, SphereEmitter, DiskEmitter, CylinderEmitter>;

/// World-space area, m².
float area(const EmitterShape& shape);
/// Samples a point uniformly by area. The shape's area must not be 0.
EmitterPoint sample_area(const EmitterShape& shape, const Vec2& u);
/// The numbers in [0,1)² from which `sample_area` draws a point of the shape. Nullopt for shapes whose sampling rejects
/// some numbers (stretched spheres and cylinders, twisted patches) and for whole round spheres.
std::optional<Vec2> invert_sample_area(const EmitterShape& shape, const Point& point);
/// Samples a point for next-event estimation from `from`: by solid angle if that pays, by area otherwise. Returns
/// nullopt if the density is not finite or the emitter is seen edge-on. May return points that face away.
std::optional<EmitterDirection> sample_towards(const EmitterShape& shape, const Point& from, const Vec2& u);
/// Density of `sample_towards`, per solid angle, for the point `hit` with geometric normal `normal` (of either side).
float pdf_towards(const EmitterShape& shape, const Point& from, const Point& hit, const Normal& normal);
/// World-space bounding box of the emitter.
Bounds bounds(const EmitterShape& shape);
/// Cone that contains the emitter's natural normals.
NormalCone normal_cone(const EmitterShape& shape);

}  // namespace lanthorn
