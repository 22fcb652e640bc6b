// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Geometry of emitting surfaces as self-contained values. Every emitter draws its points uniformly by world-space area,
// whatever the transform, so that photons of a diffuse light carry equal flux and the density is 1 / area everywhere.
// Normals are the shape's natural ones, before orientation: AreaLight flips them.
#pragma once

#include <concepts>
#include <optional>
#include <variant>

#include "light/cylinder_emitter.h"
#include "light/disk_emitter.h"
#include "light/emitter_sample.h"
#include "light/patch_emitter.h"
#include "light/sphere_emitter.h"
#include "light/triangle_emitter.h"
#include "math/vec.h"

namespace lanthorn {

/// What a shape of light has. To add one: a file of its own, and its name in `EmitterShape`. It may also have
/// `sample_towards` and `pdf_towards` as the functions below; else points are drawn by area.
template <class Shape>
concept Emitter = requires(const Shape& shape, const Vec2& u) {
  { shape.area } -> std::convertible_to<float>;  // world space, m²
  { shape.sample_area(u) } -> std::same_as<EmitterPoint>;
  { shape.bounds() } -> std::same_as<Bounds>;  // world space
  { shape.normal_cone() } -> std::same_as<NormalCone>;
};

using EmitterShape = std::variant<TriangleEmitter, PatchEmitter, SphereEmitter, DiskEmitter, CylinderEmitter>;

/// World-space area, m².
float area(const EmitterShape& shape);
/// A point uniform by area. The shape's area must not be 0.
EmitterPoint sample_area(const EmitterShape& shape, const Vec2& u);
/// The numbers in [0,1)² from which `sample_area` draws a point of the shape. Triangles and parallelograms know them;
/// empty for all others.
std::optional<Vec2> invert_sample_area(const EmitterShape& shape, const Point& point);
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
