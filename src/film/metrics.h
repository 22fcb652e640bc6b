// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How far apart two pictures are, and whether noise alone explains it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "lanthorn/image.h"

namespace lanthorn {

/// Errors of a picture against its reference, over all pixels and channels. Values that are not finite in either
/// picture are left out and counted.
struct ImageErrors {
  double mse = 0;                    ///< mean (a - r)^2
  double rel_mse = 0;                ///< mean (a - r)^2 / (r^2 + epsilon)
  double mean_image = 0;             ///< mean a
  double mean_reference = 0;         ///< mean r
  std::optional<double> mean_ratio;  ///< mean a / mean r; none if the reference's mean is 0
  double max_difference = 0;         ///< max |a - r|
  std::size_t non_finite = 0;        ///< values left out
};

struct ErrorOptions {
  double epsilon = 0.01;  ///< of relMSE; in the square of the picture's unit
  std::optional<double>
      rel_clamp;  ///< each value's relative square error is at most this: keeps fireflies from deciding
};

/// Both pictures must have equal sizes and numbers of channels (`lanthorn::Error` otherwise).
ImageErrors image_errors(const Image& image, const Image& reference, const ErrorOptions& options = {});

/// Whether renders agree with a reference within their noise.
struct Agreement {
  bool agrees = false;
  double mean_difference = 0;  ///< (mean of runs - mean of reference) / mean of reference
  double mean_error = 0;       ///< its standard error
  double outliers = 0;         ///< fraction of tile channels that differ significantly
  double rel_mse = 0;          ///< of tiles: mean d^2 / (r^2 + 0.01 mean(r)^2)
};

/// The test of the conformance suite (tests/conformance/README.md). Pixels are averaged over 8x8 tiles (what is left
/// over at right and bottom is ignored); a tile's z uses the reference's standard errors `sem` and those of the runs'
/// mean, which are taken to be no less than half their median. Agreement: at most 3 % of tile channels beyond |z| = 4
/// and beyond 3 % of the image's mean; and the image's mean within 1 % or 4 standard errors. `runs`: at least two
/// independent renders; all pictures of equal size and channels, at least one tile (`lanthorn::Error` otherwise).
Agreement agreement_with_reference(const Image& reference, const Image& sem, std::span<const Image> runs);

/// Whether two sets of renders have equal expectations.
struct Comparison {
  double smallest_p = 1;       ///< of any tile channel, uncorrected
  double p = 1;                ///< Sidak-corrected: the chance that noise alone gives `smallest_p` or less somewhere
  std::size_t tests = 0;       ///< tile channels tested
  int tile_x = 0, tile_y = 0;  ///< of the smallest p; tiles count from the upper left
  std::size_t channel = 0;
};

/// Welch's t-test for each channel of each 8x8 tile (mean over pixels), two-sided, over at least two independent
/// renders on each side; equal sizes and channels (`lanthorn::Error` otherwise). Tiles that are the same in all renders
/// of both sides count as p = 1; those without noise that differ as p = 0. "p < 0.01" has a false-alarm rate of 1 % for
/// the whole picture (tiles are taken as independent).
Comparison welch_tile_test(std::span<const Image> a, std::span<const Image> b);

/// Two-sided p-value of Student's t with `degrees` > 0 (not necessarily whole) degrees of freedom.
double student_t_p_value(double t, double degrees);

}  // namespace lanthorn
