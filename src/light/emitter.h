// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Geometry of emitting surfaces as self-contained values. Every emitter samples its points uniformly by world-space
// area, whatever the transform: the density is 1 / area, and photons of a diffuse light carry equal flux. Normals are
// the shape's natural ones, before orientation; AreaLight flips them.
#pragma once

#include <concepts>
#include <optional>
#include <variant>

#include "light/emitter_sample.h"
#include "light/parallelogram_emitter.h"
#include "light/patch_emitter.h"
#include "light/quadric_emitters.h"
#include "light/triangle_emitter.h"
#include "math/vec.h"

namespace lanthorn {

/// Requirements on a light's shape. To add a shape: give it its own file, and add its name to `EmitterShape`. It may
/// also have `sample_towards` and `pdf_towards` like the functions below; otherwise points are sampled by area.
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
