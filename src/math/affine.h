// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Affine maps in double precision, and the motion between two of them, prepared for evaluation at many times.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "lanthorn/transform.h"

namespace lanthorn {

/// x -> linear * x + translation, stored with the inverse of `linear`.
struct Affine {
  DMat3 linear{1.0};
  DMat3 inverse{1.0};
  DVec3 translation{0.0};

  Affine() = default;
  explicit Affine(const Transform& t) : Affine(DMat3(t.matrix), DVec3(t.matrix[3])) {}
  Affine(const DMat3& l, const DVec3& t) : linear(l), inverse(glm::inverse(l)), translation(t) {}

  DVec3 point(const DVec3& p) const { return linear * p + translation; }
  DVec3 vector(const DVec3& v) const { return linear * v; }
  DVec3 inverse_point(const DVec3& p) const { return inverse * (p - translation); }
  DVec3 inverse_vector(const DVec3& v) const { return inverse * v; }
  /// Maps a normal by the inverse transpose; not normalised.
  DVec3 normal(const DVec3& n) const { return n * inverse; }

  friend Affine operator*(const Affine& a, const Affine& b) { return {a.linear * b.linear, a.point(b.translation)}; }
};

/// Maximum absolute row sum: bound of the result for coordinates of magnitude at most 1. Infinite if an entry is NaN.
double row_norm(const DMat3& m);

/// Evaluates AnimatedTransform::at with the decomposition done once: for a moving lens, object or shape.
class Motion {
 public:
  Motion() = default;
  explicit Motion(const AnimatedTransform& t);

  bool is_moving() const { return moving_; }
  /// The map at `time`, clamped to the time interval of the AnimatedTransform. `moved` is storage for the result if
  /// there is motion; otherwise nothing is copied.
  const Affine& at(float time, std::optional<Affine>& moved) const {
    if (!moving_ || time <= start_time_) return fixed_start_;
    return moved.emplace(between(time));
  }

 private:
  Affine between(float time) const;
  struct Pose {
    DVec3 translation{0.0};
    glm::dquat rotation{1, 0, 0, 0};
    DMat3 stretch{1.0};
  };
  static Pose decompose(const Transform& t);

  bool moving_ = false;
  float start_time_ = 0, end_time_ = 1;
  Pose start_, end_;
  Affine fixed_start_, fixed_end_;
};

}  // namespace lanthorn
