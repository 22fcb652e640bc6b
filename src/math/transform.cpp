// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/transform.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace lanthorn {

namespace {

struct Decomposed {
  DVec3 translation;
  glm::dquat rotation;
  DMat3 stretch;
};

// M = T R S by polar decomposition (Shoemake & Duff 1992, "Matrix Animation and Polar Decomposition").
Decomposed decompose(const DMat4& matrix) {
  const DMat3 m(matrix);
  DMat3 r = m;
  for (int i = 0; i < 100; ++i) {
    const DMat3 next = 0.5 * (r + glm::inverse(glm::transpose(r)));
    double change = 0;
    for (int c = 0; c < 3; ++c) change = std::max(change, glm::length(next[c] - r[c]));
    r = next;
    if (change < 1e-12) break;
  }
  if (glm::determinant(r) < 0) r = -r;  // a reflection belongs to the stretch
  return {DVec3(matrix[3]), glm::quat_cast(r), glm::inverse(r) * m};
}

}  // namespace

Transform::Transform(const DMat4& m) : matrix(m), inverse(glm::inverse(m)) {}

Bounds Transform::bounds(const Bounds& b) const {
  Bounds result;
  if (b.empty()) return result;
  for (int corner = 0; corner < 8; ++corner)
    result.extend(
        point({corner & 1 ? b.max.x : b.min.x, corner & 2 ? b.max.y : b.min.y, corner & 4 ? b.max.z : b.min.z}));
  return result;
}

bool Transform::swaps_handedness() const { return glm::determinant(DMat3(matrix)) < 0; }

bool Transform::is_singular() const {
  const auto is_single = [](double x) { return std::isfinite(static_cast<float>(x)); };
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!is_single(matrix[c][r]) || !is_single(inverse[c][r])) return true;
  return glm::determinant(DMat3(matrix)) == 0;
}

Transform translate(const DVec3& offset) {
  DMat4 m(1.0), inv(1.0);
  m[3] = glm::dvec4(offset, 1);
  inv[3] = glm::dvec4(-offset, 1);
  return {m, inv};
}

Transform scale(const DVec3& factors) {
  DMat4 m(1.0), inv(1.0);
  for (int i = 0; i < 3; ++i) {
    m[i][i] = factors[i];
    inv[i][i] = 1 / factors[i];
  }
  return {m, inv};
}

Transform rotate(double degrees, const DVec3& axis) {
  const DMat3 r = glm::mat3_cast(glm::angleAxis(degrees * std::numbers::pi / 180, glm::normalize(axis)));
  return {DMat4(r), DMat4(glm::transpose(r))};
}

Transform look_at(const DVec3& eye, const DVec3& target, const DVec3& up) {
  const DVec3 forward = glm::normalize(target - eye);
  const DVec3 right = glm::normalize(glm::cross(glm::normalize(up), forward));
  const DVec3 new_up = glm::cross(forward, right);
  const DMat4 camera_to_world(glm::dvec4(right, 0), glm::dvec4(new_up, 0), glm::dvec4(forward, 0), glm::dvec4(eye, 1));
  return Transform(camera_to_world).inverted();
}

Transform AnimatedTransform::at(float time) const {
  if (!is_moving() || time <= start_time) return start;
  if (time >= end_time) return end;
  const double t = static_cast<double>(time - start_time) / static_cast<double>(end_time - start_time);
  const Decomposed a = decompose(start.matrix);
  const Decomposed b = decompose(end.matrix);
  const DMat3 linear = glm::mat3_cast(glm::slerp(a.rotation, b.rotation, t)) * (a.stretch * (1 - t) + b.stretch * t);
  DMat4 m(linear);
  m[3] = glm::dvec4((1 - t) * a.translation + t * b.translation, 1);
  return Transform(m);
}

}  // namespace lanthorn
