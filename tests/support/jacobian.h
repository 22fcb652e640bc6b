// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A sampler's pdf is the inverse of its area stretch of the unit square: |d sample / d u| * pdf = 1. Finite differences
// check this point by point, which finds wrong factors that statistics would need many samples for.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "math/hash.h"
#include "math/vec.h"

namespace lanthorn::test {

struct JacobianOptions {
  int points = 400;         ///< of the unit square
  float step = 2e-3f;       ///< step of the central differences
  double tolerance = 0.03;  ///< relative
  /// Fraction of the points that must agree: differences across a seam of the warp (phi = 0, the diagonals of the
  /// concentric disk) do not.
  double share = 0.94;
  float u1 = 0.5f;  ///< the first number given to `sample`, held fixed
  std::uint64_t seed = 1;
};

/// |d sample / d u| at u, per unit area of the square, for a `sample(u1, u)` into a plane (Vec2) or space (Vec3: area
/// of the parallelogram of the tangents, which is solid angle on the unit sphere). Empty if some draw around u fails.
template <class Sample>
std::optional<double> jacobian(const Sample& sample, float u1, const Vec2& u, float step) {
  const auto x0 = sample(u1, u - Vec2(step, 0));
  const auto x1 = sample(u1, u + Vec2(step, 0));
  const auto y0 = sample(u1, u - Vec2(0, step));
  const auto y1 = sample(u1, u + Vec2(0, step));
  if (!x0 || !x1 || !y0 || !y1) return std::nullopt;
  const auto dx = (*x1 - *x0) / (2 * step);
  const auto dy = (*y1 - *y0) / (2 * step);
  if constexpr (std::is_same_v<decltype(dx), const Vec2>) {
    return std::fabs(dx.x * dy.y - dx.y * dy.x);
  } else {
    return std::sqrt(length_squared(cross(dx, dy)));
  }
}

/// True if |d sample / d u| * pdf is 1 at almost all of the points where there is a sample. `sampler` as in chi2.h.
template <class Sampler>
::testing::AssertionResult jacobian_test(const Sampler& sampler, const JacobianOptions& options = {}) {
  HashRng rng(options.seed);
  int tested = 0;
  int agreed = 0;
  double worst = 0;
  for (int i = 0; i < options.points; ++i) {
    const Vec2 u = Vec2(options.step) + (1 - 2 * options.step) * rng.next2();
    const auto sample = sampler.sample(options.u1, u);
    const auto area = jacobian(sampler.sample, options.u1, u, options.step);
    if (!sample || !area) continue;
    const double error = std::fabs(*area * static_cast<double>(sampler.pdf(*sample)) - 1);
    ++tested;
    if (error < options.tolerance) ++agreed;
    if (!(error <= worst)) worst = error;
  }
  auto result =
      tested >= 10 && agreed >= options.share * tested ? ::testing::AssertionSuccess() : ::testing::AssertionFailure();
  return result << agreed << " of " << tested << " points agree, worst relative error " << worst;
}

}  // namespace lanthorn::test
