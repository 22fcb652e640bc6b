// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Directions to a triangle, sampled uniformly by solid angle (Arvo 1995, in the form of Peters 2021, "BRDF Importance
// Sampling for Polygonal Lights", section 3).
#pragma once

#include <array>
#include <cmath>

#include "math/vec.h"

namespace lanthorn {

/// A triangle seen from a point.
struct SphericalTriangle {
  std::array<Direction, 3> v;  ///< to its corners
  float det, dots, base;       ///< |v0 v1 v2|, (v0 + v1).v2, 1 + v0.v1
  float solid_angle;           ///< sr, in [0, 2 pi] (van Oosterom & Strackee 1983)

  /// `determinant`: |v0 v1 v2|, computed from the height above the plane, because the triple product of nearly parallel
  /// unit vectors cancels.
  SphericalTriangle(const Direction& v0, const Direction& v1, const Direction& v2, float determinant)
      : v{v0, v1, v2},
        det(determinant),
        dots(dot(v0 + v1, v2)),
        base(1 + dot(v0, v1)),
        solid_angle(2 * std::atan2(det, dots + base)) {}

  /// Peters 2021, section 3: v2 moves towards v0 until the remaining triangle has the solid angle u.x * all; u.y then
  /// selects a point of the arc from v1 to the moved vertex. h is the direction half way between v0 and the moved
  /// vertex.
  Direction sample(const Vec2& u) const {
    const float half = 0.5f * u.x * solid_angle;
    const float sin = std::sin(half), cos = std::cos(half);
    const Vec3 h = (det * cos - dots * sin) * v[0] + (base * sin) * v[2];
    const float h2 = length_squared(h);
    const Direction moved = h2 > 0 ? (2 * dot(v[0], h) / h2) * h - v[0] : v[0];
    const Vec3 chord = moved - v[1];
    const float one_minus_cos = u.y * 0.5f * length_squared(chord);
    const Vec3 tangent = chord - dot(chord, v[1]) * v[1];
    const float tangent_length = std::sqrt(length_squared(tangent));
    if (!(tangent_length > 0)) return v[1];
    return (1 - one_minus_cos) * v[1] + (safe_sqrt(one_minus_cos * (2 - one_minus_cos)) / tangent_length) * tangent;
  }
};

/// False for small solid angles, for which area sampling is as good, and for receiving points almost in the emitter.
inline bool is_well_conditioned(float solid_angle) { return solid_angle > 2e-5f && solid_angle < 6.2f; }

}  // namespace lanthorn
