// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The angular profile of a surface behind a grid of deep slats (a soft box), as Cycles models it.
#pragma once

#include <cmath>
#include <numbers>

#include "math/sampling.h"
#include "math/vec.h"

namespace lanthorn {

/// The factor of a diffuse emitter's radiance at the angle θ to the normal: the slats leave 1 - tan θ / tan h of it, up
/// to the half angle h. The factor's mean over the emitter's directions is 1,
///   ∫ (1 - tan θ / tan h) 2 cos θ sin θ dθ = 1 - h / tan h  over [0, h],
/// so that the power is the same as for the diffuse emitter.
class Spread {
 public:
  /// A diffuse emitter.
  Spread() = default;
  /// `half_angle`: h, radians, in (0, π/2].
  explicit Spread(double half_angle) {
    if (half_angle >= 0.5 * std::numbers::pi) return;
    tan_ = static_cast<float>(std::tan(half_angle));
    peak_ = static_cast<float>(1 / (1 - half_angle / std::tan(half_angle)));
  }

  bool is_diffuse() const { return tan_ == infinity; }
  /// The factor along the normal, which is the largest.
  float peak() const { return peak_; }
  float sin() const { return is_diffuse() ? 1.0f : tan_ / std::sqrt(1 + tan_ * tan_); }
  float cos() const { return is_diffuse() ? 0.0f : 1 / std::sqrt(1 + tan_ * tan_); }

  /// `cos`: of the angle to the normal, in [0,1].
  float factor(float cos) const {
    if (is_diffuse()) return 1;
    const float left = cos * tan_ - safe_sqrt(1 - cos * cos);
    return left > 0 ? peak_ * left / (cos * tan_) : 0.0f;
  }
  /// Density per solid angle of the directions that `sample` draws.
  float pdf(float cos) const {
    if (is_diffuse()) return pdf_cosine_hemisphere(cos);
    const float sine = sin();
    return cos > this->cos() ? pdf_cosine_hemisphere(cos) / (sine * sine) : 0.0f;
  }
  /// Draws a direction inside the cone around z, in proportion to its cosine.
  Direction sample(const Vec2& u) const {
    if (is_diffuse()) return sample_cosine_hemisphere(u);
    const Vec2 d = sin() * sample_concentric_disk(u);
    return {d.x, d.y, safe_sqrt(1 - dot(d, d))};
  }
  /// The numbers from which `sample` draws a direction.
  Vec2 invert(const Direction& direction) const {
    return invert_concentric_disk(Vec2(direction.x, direction.y) / sin());
  }

 private:
  float tan_ = infinity, peak_ = 1;  // of the half angle; along the normal
};

}  // namespace lanthorn
