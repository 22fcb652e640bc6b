// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Surfaces under affine maps.
#pragma once

#include <cmath>
#include <glm/mat3x3.hpp>

#include "math/vec.h"

namespace lanthorn {

/// Length of a vector.
inline float norm(const Vec3& v) { return std::sqrt(length_squared(v)); }

/// The coordinates (a, b) of a point p0 + a (p1 - p0) + b (p2 - p0); 0 if the three points are collinear.
Vec2 barycentric(const Point& p0, const Point& p1, const Point& p2, const Point& point);

/// Factor by which the affine map M scales area with normal n: |cofactor(M) n|.
float stretch(const glm::mat3& linear, const Normal& n);
/// The image of a normal under the map M, unit: along cofactor(M) n / det(M).
Normal map_normal(const glm::mat3& linear, const Normal& n);
/// Upper bound of `stretch` over normals in the span of the first `dimensions` axes, by Gershgorin's theorem (tight for
/// scaling along the axes). 0 if `stretch` is the same for all of them.
float max_stretch(const glm::mat3& linear, int dimensions);

/// Half size of the bounding box of the image of the unit ball, for the map with columns x, y, z.
Vec3 half_extent(const Vec3& x, const Vec3& y, const Vec3& z = Vec3(0));
inline Bounds box_around(const Point& centre, const Vec3& half) { return {centre - half, centre + half}; }

}  // namespace lanthorn
