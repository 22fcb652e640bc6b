// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Hair and fur: cubic Bézier curves with a width.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "description/scene_description.h"
#include "math/affine.h"
#include "math/transform.h"
#include "math/vec.h"

namespace lanthorn {

/// Appends cubic Bézier segments that share their end points. `points`: 3 n + 1 control points of n >= 1 segments. The
/// width runs linearly from `width0` to `width1` over all of them. `normals`: n + 1 unit vectors at the ends of the
/// segments (ribbons), or none; in between they turn evenly, as a slerp would, to within 0.001 for angles up to 90
/// degrees.
void append_curve(description::Curves& curves, std::span<const DVec3> points, float width0, float width1,
                  std::span<const Normal> normals);

/// Appends curves of the same kind.
void append(description::Curves& curves, const description::Curves& more);

/// The factor by which the map scales all lengths, to within rounding; nothing if it scales some more than others.
std::optional<float> even_scale(const Transform& t);
/// The curves in the space that `t`, which scales evenly, leads to.
description::Curves transformed(description::Curves curves, const Transform& t);
/// The same curves with every segment cut into `pieces`, which share its range of u.
description::Curves cut(const description::Curves& curves, std::uint32_t pieces);
/// Throws Error if there are indices out of range or too few normals.
void check_curves(const description::Curves& curves, const SourceLocation& location);

/// Triangles in the place of curves, for those that emit. Tubes have polygons for circles, of the same perimeter: a
/// straight one of constant width keeps its area, open ends included. A flat curve becomes the tube of its width, which
/// looks as wide from everywhere; a ribbon stays one. u runs from 0 to 1 along the pieces of a segment, v across a
/// ribbon or once around a tube. The curves must have passed `check_curves`.
description::TriangleMesh triangulated(const description::Curves& curves);

/// The surface where a ray meets a curve.
struct CurvePoint {
  DVec3 position{0.0};
  /// How far along the normal a ray must start that is not to meet the curve again, metres: the radius for flat curves,
  /// which turn towards every ray; a small part of it for the others.
  double error = 0;
  DVec3 normal{0.0};  ///< unit; flat: towards the ray's origin; cylinder: away from the axis; ribbon: its given side
  DVec3 dpdu{0.0};    ///< along the curve, not normalised
  DVec3 dpdv{0.0};    ///< across, in the surface; as long as the curve is wide
  Vec2 uv{0};         ///< u: 0 to 1 along the pieces of a segment; v: 0 to 1 across, as seen along the ray
};
/// At parameter `u` of a piece of a segment, near the point `near` of its surface, for a ray of direction `along` (not
/// 0).
CurvePoint evaluate(const description::Curves& curves, std::uint32_t segment, float u, const DVec3& near,
                    const DVec3& along);

}  // namespace lanthorn
