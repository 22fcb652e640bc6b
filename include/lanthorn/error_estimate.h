// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How far a picture is from the truth, as its own samples tell.
#pragma once

#include <string>

namespace lanthorn {

/// Estimate of a picture's error: √ of the mean over pixels and channels of min(1, (a − r)² / (r² + 0.01 m²)), where a
/// is the picture, r the truth, and m the mean of the truth. It does not depend on exposure, and a firefly counts as
/// one pixel. 0.02 is an error of 2 % of each value, or of 0.2 % of the mean where it is dark.
struct ErrorEstimate {
  double noise = 0;   ///< the part that falls with the number of passes alone
  double bias = 0;    ///< the part that falls with the radii of photons; 0 of methods without bias
  double error = 0;   ///< of both: √(noise² + bias²)
  double bound = 0;   ///< the error is below it with a probability of 90 %
  std::string doubt;  ///< why the numbers are too small, or not known; empty if they can be relied on

  bool is_known() const { return doubt.empty(); }
  bool is_below(double limit) const { return is_known() && bound <= limit; }
};

/// For the user: "below 1.9 %", or "not known: there are too few passes".
std::string describe_error(const ErrorEstimate& estimate);

/// How many times as many passes will bring the bound below `limit`, if noise falls as 1/√n does and the bias as radii
/// of progressive photon mapping do, by n^(-1/3). At least 1.
double growth_to_reach(const ErrorEstimate& estimate, double limit);

}  // namespace lanthorn
