// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// References:
//   Shoemake, Duff 1992, "Matrix Animation and Polar Decomposition".
#include "math/affine.h"

#include <algorithm>
#include <cmath>

namespace lanthorn {

double row_norm(const DMat3& m) {
  double largest = 0;
  for (int r = 0; r < 3; ++r) {
    const double sum = std::fabs(m[0][r]) + std::fabs(m[1][r]) + std::fabs(m[2][r]);
    largest = std::isnan(sum) ? HUGE_VAL : std::max(largest, sum);
    if (largest == HUGE_VAL) break;
  }
  return largest;
}

Motion::Pose Motion::decompose(const Transform& t) {
  const DMat3 m(t.matrix);
  DMat3 r = m;
  for (int i = 0; i < 100; ++i) {
    const DMat3 next = 0.5 * (r + glm::inverse(glm::transpose(r)));
    double change = 0;
    for (int c = 0; c < 3; ++c) change = std::max(change, glm::length(next[c] - r[c]));
    r = next;
    if (change < 1e-14) break;
  }
  if (glm::determinant(r) < 0) r = -r;
  return {DVec3(t.matrix[3]), glm::quat_cast(r), glm::transpose(r) * m};
}

Motion::Motion(const AnimatedTransform& t)
    : moving_(t.is_moving()),
      start_time_(t.start_time),
      end_time_(t.end_time),
      fixed_start_(t.start),
      fixed_end_(t.end) {
  if (!moving_) return;
  start_ = decompose(t.start);
  end_ = decompose(t.end);
  // Interpolates along the shorter arc. Chosen once, so that all times lie on the same path.
  if (glm::dot(start_.rotation, end_.rotation) < 0) end_.rotation = -end_.rotation;
}

Affine Motion::between(float time) const {
  if (time >= end_time_) return fixed_end_;
  const double t = (static_cast<double>(time) - start_time_) / (static_cast<double>(end_time_) - start_time_);
  const DMat3 linear =
      glm::mat3_cast(glm::slerp(start_.rotation, end_.rotation, t)) * (start_.stretch * (1 - t) + end_.stretch * t);
  return {linear, (1 - t) * start_.translation + t * end_.translation};
}

}  // namespace lanthorn
