// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Estimates a picture's error from its own samples.
#pragma once

#include <string>

namespace lanthorn {

/// Estimate of a picture's error: √ of the mean over pixels and channels of min(1, (a − r)² / (r² + 0.01 m²)), where a
/// is the picture, r the converged picture, and m the mean of r. It does not depend on exposure, and each firefly
/// counts as at most one pixel. 0.02 means an error of 2 % of each value, or of 0.2 % of the mean in dark regions.
struct ErrorEstimate {
  double noise = 0;   ///< the part that only more passes reduce
  double bias = 0;    ///< the part that shrinks with the photon radii; 0 for unbiased methods
  double error = 0;   ///< both parts together: √(noise² + bias²)
  double bound = 0;   ///< upper bound of the error at 90 % confidence
  std::string doubt;  ///< why the numbers are too small or unknown; empty if they can be relied on
  /// No pixel has light after enough passes. No error relative to the light is then known, but a render that stops at
  /// an error stops: in a scene without light, more passes would change nothing.
  bool is_black = false;

  bool is_known() const { return doubt.empty(); }
  /// True if a render that stops at this error need not go on.
  bool is_below(double limit) const { return is_black || (is_known() && bound <= limit); }
};

/// For the user: "below 1.9 %"; "0 %" if all passes are alike; or "not known: there are too few passes".
std::string describe_error(const ErrorEstimate& estimate);

/// Factor by which the number of passes must grow for the bound to fall below `limit`, if noise falls as n^(-1/2) and
/// bias as n^(-1/3), as radii of progressive photon mapping do. At least 1.
double growth_to_reach(const ErrorEstimate& estimate, double limit);

}  // namespace lanthorn
