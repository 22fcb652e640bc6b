// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Geometric types: glm under the field's names. Metres; world space unless a name says `local`.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <numbers>

namespace lanthorn {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Point = glm::vec3;      ///< a position, metres
using Direction = glm::vec3;  ///< unit length, pointing away from the surface
using Normal = glm::vec3;     ///< unit length
using Mat2 = glm::mat2;
using Mat4 = glm::mat4;

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float inv_pi = std::numbers::inv_pi_v<float>;
inline constexpr float infinity = std::numeric_limits<float>::infinity();
/// Largest float below 1: samples of [0,1) stay inside it.
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;

using glm::cross;
using glm::dot;
using glm::normalize;

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

/// Axis-aligned box; empty when min > max.
struct Bounds {
  Point min{infinity};
  Point max{-infinity};

  void extend(const Point& p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
  void extend(const Bounds& b) {
    min = glm::min(min, b.min);
    max = glm::max(max, b.max);
  }
  bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
  Vec3 extent() const { return max - min; }
  Point centre() const { return 0.5f * (min + max); }
};

}  // namespace lanthorn
