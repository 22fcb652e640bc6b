// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Equal-area map between the sphere of directions and the unit square (Clarberg, "Fast Equal-Area Mapping of the
// (Hemi)Sphere using SIMD", 2008): the upper hemisphere fills the inner diamond, the lower one the four corners.
#pragma once

#include "math/vec.h"

namespace lanthorn {

/// Point of [0,1]² for a unit direction. The 4 pi steradians of the sphere map to area 1.
inline Vec2 octahedral_from_direction(const Direction& d) {
  const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  // sqrt(1 - |z|), rewritten because 1 - |z| cancels near the poles.
  const float r = std::sqrt((x * x + y * y) / (1.0f + z));
  const float phi = x == 0 && y == 0 ? 0.0f : (2 / pi) * std::atan2(y, x);
  float v = phi * r;
  float u = r - v;
  if (d.z < 0) {
    const float folded = 1.0f - v;
    v = 1.0f - u;
    u = folded;
  }
  return {0.5f * (std::copysign(u, d.x) + 1.0f), 0.5f * (std::copysign(v, d.y) + 1.0f)};
}

/// Unit direction for a point of [0,1]²; inverse of `octahedral_from_direction`.
inline Direction direction_from_octahedral(const Vec2& p) {
  const float u = 2.0f * p.x - 1.0f, v = 2.0f * p.y - 1.0f;
  const float abs_u = std::fabs(u), abs_v = std::fabs(v);
  const float signed_distance = 1.0f - (abs_u + abs_v);  // distance from the equator, positive in the upper hemisphere
  const float r = 1.0f - std::fabs(signed_distance);
  const float phi = r == 0 ? 0.0f : (pi / 4) * ((abs_v - abs_u) / r + 1.0f);
  const float r2 = r * r;
  const float sin_theta = r * safe_sqrt(2.0f - r2);
  return {std::copysign(sin_theta * std::cos(phi), u), std::copysign(sin_theta * std::sin(phi), v),
          std::copysign(1.0f - r2, signed_distance)};
}

}  // namespace lanthorn
