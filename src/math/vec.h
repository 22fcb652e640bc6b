// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Constants and functions of the geometric types.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>

#include "lanthorn/vec.h"

namespace lanthorn {

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float inv_pi = std::numbers::inv_pi_v<float>;
/// Largest float below 1: samples of [0,1) stay inside it.
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;

using glm::cross;
using glm::dot;
using glm::normalize;

/// Absolute values of the components; glm::abs would call a function through a pointer for each.
inline Vec3 abs(const Vec3& v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }
inline float length_squared(const Vec3& v) { return dot(v, v); }
inline float distance_squared(const Point& a, const Point& b) { return length_squared(a - b); }
inline float max_component(const Vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }
template <class T>
constexpr T sqr(T x) {
  return x * x;
}
inline constexpr float to_radians(float degrees) { return degrees * pi / 180; }
/// Square root of x; the small negative results of cancellation count as 0.
inline float safe_sqrt(float x) { return std::sqrt(std::max(0.0f, x)); }
inline float lerp(float t, float a, float b) { return a + t * (b - a); }

}  // namespace lanthorn
