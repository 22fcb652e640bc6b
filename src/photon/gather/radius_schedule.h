// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The radius of each pass of progressive photon mapping.
#pragma once

#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace lanthorn {

/// log Γ(x), x > 0, by Stirling's series after raising x above 16; relative error of Γ below 1e-14. Unlike std::lgamma
/// it writes no global state, so that it is thread-safe.
inline double log_gamma(double x) {
  double below = 1;
  for (; x < 16; ++x) below *= x;
  const double inv = 1 / x, inv2 = inv * inv;
  const double series = inv * (1.0 / 12 - inv2 * (1.0 / 360 - inv2 * (1.0 / 1260 - inv2 / 1680)));
  return (x - 0.5) * std::log(x) - x + 0.5 * std::log(2 * std::numbers::pi) + series - std::log(below);
}

/// Radii by r²_{i+1} = r²_i (i + α)/(i + 1), i = 1, 2, … (Knaus & Zwicker 2011, eq. 15). The radius is a function of
/// the pass number alone, so that passes are independent. With α near 1 it shrinks slowly: little noise, slowly falling
/// bias.
struct RadiusSchedule {
  double first_radius = 1;  ///< m, radius of the first pass
  double alpha = 2.0 / 3;   ///< in (0, 1]

  /// r² / r²_1 of pass `pass` (the first is 0): Γ(i + α) / (Γ(1 + α) Γ(i + 1)) with i = pass + 1.
  double shrink2(std::uint64_t pass) const { return shrink2_after(static_cast<double>(pass) + 1); }
  /// The same after the photons of i passes, i >= 1. i need not be a whole number, because passes may have more or
  /// fewer photons than the pass for which the first radius is measured.
  double shrink2_after(double i) const {
    assert(alpha > 0 && alpha <= 1);
    return i == 1 ? 1 : std::exp(log_gamma(i + alpha) - log_gamma(1 + alpha) - log_gamma(i + 1));
  }
  /// r / r_1 of pass `pass`. The variance of a density estimate is inversely proportional to r^dimensions. This power
  /// therefore follows the schedule that r² follows in two dimensions (Knaus & Zwicker 2011, section 5).
  float shrink(std::uint64_t pass, int dimensions) const {
    return static_cast<float>(std::pow(shrink2(pass), 1.0 / dimensions));
  }
  /// Radius (m) of pass `pass` (the first is 0).
  float radius(std::uint64_t pass) const { return static_cast<float>(first_radius * std::sqrt(shrink2(pass))); }
};

}  // namespace lanthorn
