// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "math/vec.h"

namespace lanthorn {

/// A right-handed orthonormal basis; local z is the normal n.
struct Frame {
  Vec3 s{1, 0, 0};
  Vec3 t{0, 1, 0};
  Vec3 n{0, 0, 1};

  Frame() = default;
  Frame(const Vec3& s_, const Vec3& t_, const Vec3& n_) : s(s_), t(t_), n(n_) {}

  /// A frame around a unit vector, continuous except where n.z changes sign (Duff et al. 2017).
  explicit Frame(const Normal& normal) : n(normal) {
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z);
    const float b = normal.x * normal.y * a;
    s = {1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
    t = {b, sign + normal.y * normal.y * a, -normal.y};
  }

  /// A frame around `normal` with s as near to `tangent` as possible; any frame if the two are parallel.
  static Frame from_normal_tangent(const Normal& normal, const Vec3& tangent) {
    const Vec3 s = tangent - normal * dot(normal, tangent);
    const float length2 = length_squared(s);
    if (!(length2 > 1e-20f * length_squared(tangent)) || !std::isfinite(length2)) return Frame(normal);
    const Vec3 unit = s / std::sqrt(length2);
    return {unit, cross(normal, unit), normal};
  }

  Vec3 to_local(const Vec3& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  Vec3 to_world(const Vec3& v) const { return v.x * s + v.y * t + v.z * n; }
};

// Spherical functions of a local unit vector (z is the normal).
inline float abs_cos_theta(const Vec3& local) { return std::fabs(local.z); }
inline float cos2_theta(const Vec3& local) { return local.z * local.z; }
inline float sin2_theta(const Vec3& local) { return std::max(0.0f, 1.0f - cos2_theta(local)); }
inline bool same_hemisphere(const Vec3& a, const Vec3& b) { return a.z * b.z > 0.0f; }

}  // namespace lanthorn
