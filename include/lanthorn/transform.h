// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lanthorn/vec.h"

namespace lanthorn {

/// An affine (or, for cameras, projective) map with its inverse. Column vectors: (A * B) applies B first. Double
/// precision, so that chains of maps far from the origin place small objects accurately.
struct Transform {
  DMat4 matrix{1.0};
  DMat4 inverse{1.0};

  Transform() = default;
  explicit Transform(const DMat4& m);  ///< inverts m; if that fails, `is_singular()` is true
  explicit Transform(const Mat4& m) : Transform(DMat4(m)) {}
  Transform(const DMat4& m, const DMat4& inv) : matrix(m), inverse(inv) {}

  Point point(const Point& p) const { return Point(matrix * glm::dvec4(p, 1.0)); }
  /// Like `point`, with division by w.
  Point project(const Point& p) const {
    const glm::dvec4 q = matrix * glm::dvec4(p, 1.0);
    return Point(DVec3(q) / q.w);
  }
  Vec3 vector(const Vec3& v) const { return Vec3(DMat3(matrix) * DVec3(v)); }
  /// Maps a normal by the inverse transpose; not normalised.
  Vec3 normal(const Vec3& n) const { return Vec3(DVec3(n) * DMat3(inverse)); }
  Bounds bounds(const Bounds& b) const;

  Transform inverted() const { return {inverse, matrix}; }
  /// True if the map mirrors: turns right-handed coordinates into left-handed ones.
  bool swaps_handedness() const;
  bool is_singular() const;
  bool is_identity() const { return matrix == DMat4(1.0); }

  friend Transform operator*(const Transform& a, const Transform& b) {
    return {a.matrix * b.matrix, b.inverse * a.inverse};
  }
  friend bool operator==(const Transform& a, const Transform& b) { return a.matrix == b.matrix; }
};

Transform translate(const DVec3& offset);
Transform scale(const DVec3& factors);
/// Right-handed rotation about `axis` (any length) by `degrees`.
Transform rotate(double degrees, const DVec3& axis);
/// World to camera, for a camera at `eye` looking along +z with +y near `up`, left-handed as in pbrt.
Transform look_at(const DVec3& eye, const DVec3& target, const DVec3& up);

/// Two affine maps at two times. In between, translation and stretch are interpolated linearly and the rotation
/// spherically (Shoemake & Duff 1992), as in pbrt.
struct AnimatedTransform {
  Transform start;
  Transform end;
  float start_time = 0;
  float end_time = 1;

  AnimatedTransform() = default;
  explicit AnimatedTransform(const Transform& fixed) : start(fixed), end(fixed) {}
  AnimatedTransform(const Transform& s, const Transform& e, float t0, float t1)
      : start(s), end(e), start_time(t0), end_time(t1) {}

  bool is_moving() const { return !(start == end); }
  /// The map at `time`, clamped to [start_time, end_time].
  Transform at(float time) const;
  friend bool operator==(const AnimatedTransform&, const AnimatedTransform&) = default;
};

}  // namespace lanthorn
