// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Differences between two pictures, and tests whether noise alone explains them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "lanthorn/image.h"

namespace lanthorn {

/// Errors of a picture a against its reference r, over all pixels and channels. Values that are not finite in either
/// picture are excluded and counted.
struct ImageErrors {
  double mse = 0;                    ///< mean (a - r)^2
  double rel_mse = 0;                ///< mean (a - r)^2 / (r^2 + epsilon)
  double mean_image = 0;             ///< mean a
  double mean_reference = 0;         ///< mean r
  std::optional<double> mean_ratio;  ///< mean a / mean r; none if the reference's mean is 0
  double max_difference = 0;         ///< max |a - r|
  std::size_t non_finite = 0;        ///< number of excluded values
};

struct ErrorOptions {
  double epsilon = 0.01;            ///< of relMSE, in the square of the picture's unit
  std::optional<double> rel_clamp;  ///< clamps each value's relative squared error, against fireflies
};

/// Throws `lanthorn::Error` unless both pictures have equal sizes and numbers of channels.
ImageErrors image_errors(const Image& image, const Image& reference, const ErrorOptions& options = {});

/// Result of the test whether renders agree with a reference within their noise.
struct Agreement {
  bool agrees = false;
  double mean_difference = 0;  ///< (mean of runs - mean of reference) / mean of reference
  double mean_error = 0;       ///< standard error of mean_difference
  double outliers = 0;         ///< fraction of tile channels that differ significantly
  double rel_mse = 0;          ///< over tiles: mean d^2 / (r^2 + 0.01 mean(r)^2)
};

/// The test of the conformance suite (tests/conformance/README.md). Pixels are averaged over 8x8 tiles (the remainder
/// at right and bottom is ignored). A tile's z-score combines the reference's standard errors `sem` with those of the
/// runs' mean; the latter are clamped to at least half their median. The images agree if at most 3 % of tile channels
/// differ by more than |z| = 4 and by more than 3 % of the image's mean, and if the image's mean is within 1 % or 4
/// standard errors. `runs`: at least two independent renders. Throws `lanthorn::Error` unless all pictures have equal
/// size and channels and at least one tile.
Agreement agreement_with_reference(const Image& reference, const Image& sem, std::span<const Image> runs);

/// Result of the test whether two sets of renders have equal expectations.
struct Comparison {
  double smallest_p = 1;  ///< of any tile channel, uncorrected
  double p = 1;  ///< Sidak-corrected: probability that noise alone gives `smallest_p` or less in any tile channel
  std::size_t tests = 0;       ///< tile channels tested
  int tile_x = 0, tile_y = 0;  ///< tile of the smallest p; tiles count from the upper left
  std::size_t channel = 0;
};

/// Welch's two-sided t-test for each channel of each 8x8 tile (mean over pixels). Needs at least two independent
/// renders on each side, with equal sizes and channels (`lanthorn::Error` otherwise). Tiles that are identical in all
/// renders of both sides have p = 1; tiles that differ but have no noise have p = 0. "p < 0.01" has a false-alarm rate
/// of 1 % for the whole picture, assuming independent tiles.
Comparison welch_tile_test(std::span<const Image> a, std::span<const Image> b);

/// Two-sided p-value of Student's t with `degrees` > 0 (not necessarily whole) degrees of freedom.
double student_t_p_value(double t, double degrees);

}  // namespace lanthorn
