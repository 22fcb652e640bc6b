// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Hair and fur: cubic Bézier curves with width.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "lanthorn/scene_description.h"
#include "lanthorn/transform.h"
#include "math/affine.h"
#include "math/vec.h"

namespace lanthorn {

/// Appends cubic Bézier segments that share their end points. `points`: 3 n + 1 control points of n >= 1 segments. The
/// width varies linearly from `width0` to `width1` over all segments. `normals`: n + 1 unit vectors at the segments'
/// ends (ribbons), or none. Between them, normals turn uniformly, as by slerp, to within 0.001 for angles up to 90
/// degrees.
void append_curve(description::Curves& curves, std::span<const DVec3> points, float width0, float width1,
                  std::span<const Normal> normals);

/// Appends curves of the same kind.
void append(description::Curves& curves, const description::Curves& more);

/// The factor by which the map scales all lengths, to within rounding; nullopt if the factor depends on the direction.
std::optional<float> even_scale(const Transform& t);
/// The curves under the map `t`, which must scale uniformly.
description::Curves transformed(description::Curves curves, const Transform& t);
/// The same curves with every segment cut into `pieces` pieces, which share its range of u.
description::Curves cut(const description::Curves& curves, std::uint32_t pieces);
/// Throws Error if indices are out of range or there are too few normals.
void check_curves(const description::Curves& curves, const SourceLocation& location);

/// Triangle mesh of curves, for curves that emit. Circles of tubes become polygons of the same perimeter: a straight
/// tube of constant width keeps its area, open ends included. A flat curve becomes the tube of its width, which looks
/// equally wide from everywhere; a ribbon stays a ribbon. u runs from 0 to 1 along the pieces of a segment, v across a
/// ribbon or once around a tube. The curves must have passed `check_curves`.
description::TriangleMesh triangulated(const description::Curves& curves);

/// The surface at a ray's hit on a curve.
struct CurvePoint {
  DVec3 position{0.0};
  /// Distance along the normal at which a ray must start so as not to hit the curve again, metres: the radius for flat
  /// curves, which face every ray; a small fraction of it for other curves.
  double error = 0;
  DVec3 normal{0.0};  ///< unit; flat: towards the ray's origin; cylinder: away from the axis; ribbon: on its given side
  DVec3 dpdu{0.0};    ///< along the curve, not normalised
  DVec3 dpdv{0.0};    ///< across, in the surface; length equal to the curve's width
  Vec2 uv{0};         ///< u: 0 to 1 along the pieces of a segment; v: 0 to 1 across, as seen along the ray
};
/// Evaluates at parameter `u` of a piece of a segment, near the surface point `near`, for a ray of direction `along`
/// (not 0).
CurvePoint evaluate(const description::Curves& curves, std::uint32_t segment, float u, const DVec3& near,
                    const DVec3& along);

}  // namespace lanthorn
