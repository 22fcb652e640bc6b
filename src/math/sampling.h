// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Warps from [0,1)^2 to the sampled domains, each with its pdf, and the power heuristic.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace lanthorn {

/// cos(x), sin(x) for |x| <= pi/4, by the first terms of the Taylor series; the omitted terms are below half a unit in
/// the last place.
inline Vec2 cos_and_sin_below_eighth(float x) {
  const float x2 = x * x;
  return {1 - x2 / 2 * (1 - x2 / 12 * (1 - x2 / 30 * (1 - x2 / 56))),
          x * (1 - x2 / 6 * (1 - x2 / 20 * (1 - x2 / 42 * (1 - x2 / 72))))};
}

/// Uniform point on the unit disk, area-preserving and continuous (Shirley & Chiu 1997). pdf per area: 1/pi.
inline Vec2 sample_concentric_disk(const Vec2& u) {
  const Vec2 o = 2.0f * u - Vec2(1.0f);
  const bool wide = std::fabs(o.x) > std::fabs(o.y);
  const float radius = wide ? o.x : o.y;
  if (radius == 0) return {0, 0};
  const Vec2 p = radius * cos_and_sin_below_eighth((pi / 4) * ((wide ? o.y : o.x) / radius));
  return wide ? p : Vec2(p.y, p.x);
}

/// The point of the square [-r,r]² that maps to this point of a disk of any radius r.
inline Vec2 square_from_disk(const Vec2& p) {
  const bool wide = std::fabs(p.x) > std::fabs(p.y);
  const float length = std::sqrt(p.x * p.x + p.y * p.y);
  if (!(length > 0)) return Vec2(0);
  // The coordinate of the square with the larger magnitude is the radius, with the sign of the disk's coordinate.
  const float large = std::copysign(length, wide ? p.x : p.y);
  const float small = (4 / pi) * large * (wide ? std::atan(p.y / p.x) : std::atan(p.x / p.y));
  return wide ? Vec2(large, small) : Vec2(small, large);
}
/// Inverse of `sample_concentric_disk`: the u in [0,1]² that maps to this point.
inline Vec2 invert_concentric_disk(const Vec2& p) {
  const Vec2 o = square_from_disk(p);
  return {std::clamp(0.5f * (o.x + 1), 0.0f, 1.0f), std::clamp(0.5f * (o.y + 1), 0.0f, 1.0f)};
}

/// Cosine-distributed direction about local z. pdf: cos/pi.
inline Vec3 sample_cosine_hemisphere(const Vec2& u) {
  const Vec2 d = sample_concentric_disk(u);
  return {d.x, d.y, safe_sqrt(1.0f - d.x * d.x - d.y * d.y)};
}
inline float pdf_cosine_hemisphere(float cos) { return cos * inv_pi; }

/// Uniform direction. pdf: 1/(4 pi).
inline Vec3 sample_uniform_sphere(const Vec2& u) {
  const float z = 1.0f - 2.0f * u.x;
  const float r = safe_sqrt(1.0f - z * z);
  const float phi = 2 * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}
inline constexpr float pdf_uniform_sphere = 0.25f * inv_pi;

/// Angle around local z as a part of the full turn, in [0,1): the number from which azimuths are drawn.
inline float turn_around_z(float x, float y) {
  const float turn = std::atan2(y, x) / (2 * pi);
  return std::min(turn < 0 ? turn + 1 : turn, one_minus_epsilon);
}
/// Inverse of `sample_uniform_sphere`: the u in [0,1)² that maps to this direction.
inline Vec2 invert_uniform_sphere(const Vec3& d) {
  return {std::clamp(0.5f * (1 - d.z), 0.0f, one_minus_epsilon), turn_around_z(d.x, d.y)};
}

/// Uniform direction in the cone about local z with the given 1 - cos(half angle); passed in this form because the
/// cosine of a narrow cone cancels. pdf: 1/(2 pi (1 - cos)).
inline Vec3 sample_uniform_cone(const Vec2& u, float one_minus_cos) {
  const float h = u.x * one_minus_cos;  // 1 - cos of the sample
  const float r = safe_sqrt(h * (2.0f - h));
  const float phi = 2 * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), 1.0f - h};
}
/// Inverse of `sample_uniform_cone`: the u in [0,1)² that maps to this direction.
inline Vec2 invert_uniform_cone(const Vec3& d, float one_minus_cos) {
  const float sin2 = d.x * d.x + d.y * d.y;
  const float h = d.z > 0 ? sin2 / (1 + safe_sqrt(1 - sin2)) : 1 - d.z;  // 1 - cos, without cancellation
  return {std::clamp(h / one_minus_cos, 0.0f, one_minus_epsilon), turn_around_z(d.x, d.y)};
}
inline float pdf_uniform_cone(float one_minus_cos) { return 1.0f / (2 * pi * one_minus_cos); }

/// Barycentric coordinates (b0, b1) of a uniform point in a triangle, by a map of low distortion (Heitz 2019).
inline Vec2 sample_uniform_triangle(const Vec2& u) {
  if (u.x < u.y) {
    const float b0 = 0.5f * u.x;
    return {b0, u.y - b0};
  }
  const float b1 = 0.5f * u.y;
  return {u.x - b1, b1};
}
/// Inverse of `sample_uniform_triangle`: the u that maps to these coordinates.
inline Vec2 invert_uniform_triangle(const Vec2& b) {
  return b.x < b.y ? Vec2(2 * b.x, b.x + b.y) : Vec2(b.x + b.y, 2 * b.y);
}

/// Weight of a sample drawn with density `pdf` when one other technique, one sample each, would draw it with `other`:
/// power heuristic with exponent 2 (Veach 1997, eq. 9.13). Both densities in the same measure, not both 0. The
/// ratio comes first because squares of densities could overflow.
inline float power_heuristic(float pdf, float other) {
  const float ratio = other / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace lanthorn
