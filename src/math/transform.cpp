// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/transform.h"

#include <algorithm>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/quaternion.hpp>

namespace lanthorn {

namespace {

// Inverts in double precision, because scenes chain many single-precision maps.
Mat4 invert(const Mat4& m) { return Mat4(glm::inverse(glm::dmat4(m))); }

struct Decomposed {
  Vec3 translation;
  glm::quat rotation;
  glm::mat3 stretch;
};

// M = T R S by polar decomposition (Shoemake & Duff 1992, "Matrix Animation and Polar Decomposition").
Decomposed decompose(const Mat4& matrix) {
  const glm::dmat3 m(matrix);
  glm::dmat3 r = m;
  for (int i = 0; i < 100; ++i) {
    const glm::dmat3 next = 0.5 * (r + glm::inverse(glm::transpose(r)));
    double change = 0;
    for (int c = 0; c < 3; ++c) change = std::max(change, glm::length(next[c] - r[c]));
    r = next;
    if (change < 1e-12) break;
  }
  if (glm::determinant(r) < 0) r = -r;  // a reflection belongs to the stretch
  return {Vec3(matrix[3]), glm::quat_cast(glm::mat3(r)), glm::mat3(glm::inverse(r) * m)};
}

}  // namespace

Transform::Transform(const Mat4& m) : matrix(m), inverse(invert(m)) {}

Bounds Transform::bounds(const Bounds& b) const {
  Bounds result;
  if (b.empty()) return result;
  for (int corner = 0; corner < 8; ++corner)
    result.extend(
        point({corner & 1 ? b.max.x : b.min.x, corner & 2 ? b.max.y : b.min.y, corner & 4 ? b.max.z : b.min.z}));
  return result;
}

bool Transform::swaps_handedness() const { return glm::determinant(glm::mat3(matrix)) < 0; }

bool Transform::is_singular() const {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(matrix[c][r]) || !std::isfinite(inverse[c][r])) return true;
  return glm::determinant(glm::dmat3(matrix)) == 0;
}

Transform translate(const Vec3& offset) {
  Mat4 m(1.0f), inv(1.0f);
  m[3] = glm::vec4(offset, 1);
  inv[3] = glm::vec4(-offset, 1);
  return {m, inv};
}

Transform scale(const Vec3& factors) {
  Mat4 m(1.0f), inv(1.0f);
  for (int i = 0; i < 3; ++i) {
    m[i][i] = factors[i];
    inv[i][i] = 1.0f / factors[i];
  }
  return {m, inv};
}

Transform rotate(float degrees, const Vec3& axis) {
  const double angle = static_cast<double>(degrees) * std::numbers::pi / 180;
  const glm::dmat3 r = glm::mat3_cast(glm::angleAxis(angle, glm::normalize(glm::dvec3(axis))));
  const Mat4 m{glm::mat3(r)};
  return {m, glm::transpose(m)};
}

Transform look_at(const Point& eye, const Point& target, const Vec3& up) {
  const Vec3 forward = normalize(target - eye);
  const Vec3 right = normalize(cross(normalize(up), forward));
  const Vec3 new_up = cross(forward, right);
  const Mat4 camera_to_world(glm::vec4(right, 0), glm::vec4(new_up, 0), glm::vec4(forward, 0), glm::vec4(eye, 1));
  return Transform(camera_to_world).inverted();
}

Transform AnimatedTransform::at(float time) const {
  if (!is_moving() || time <= start_time) return start;
  if (time >= end_time) return end;
  const float t = (time - start_time) / (end_time - start_time);
  const Decomposed a = decompose(start.matrix);
  const Decomposed b = decompose(end.matrix);
  const glm::mat3 linear =
      glm::mat3_cast(glm::slerp(a.rotation, b.rotation, t)) * (a.stretch * (1 - t) + b.stretch * t);
  Mat4 m(linear);
  m[3] = glm::vec4((1 - t) * a.translation + t * b.translation, 1.0f);
  return Transform(m);
}

}  // namespace lanthorn
