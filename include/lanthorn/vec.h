// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Geometric types: aliases of glm's. Metres; world space unless a name says `local`.
#pragma once

#include <glm/common.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>

namespace lanthorn {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Point = glm::vec3;      ///< a position, metres
using Direction = glm::vec3;  ///< unit length, pointing away from the surface
using Normal = glm::vec3;     ///< unit length
using Mat2 = glm::mat2;
using Mat4 = glm::mat4;
using DVec3 = glm::dvec3;
using DMat3 = glm::dmat3;
using DMat4 = glm::dmat4;

inline constexpr float infinity = std::numeric_limits<float>::infinity();

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
