// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "film/film.h"
#include "lanthorn/error_estimate.h"
#include "lanthorn/image.h"

namespace lanthorn {

/// A picture in R, G, B, and the two halves of its passes (`half_of_pass`).
struct PictureHalves {
  Image picture{};
  std::array<HalfPicture, 2> halves{};
  std::array<std::uint64_t, 2> passes{};  ///< number in each half
};

/// Error estimates derived from the halves.
struct MeasuredError {
  ErrorEstimate estimate;
  Image standard_error;  ///< for R, G, B
  Image bias;            ///< signed, for R, G, B: by how much the picture is too bright
};

/// The error of a picture without any light: unknown, with a doubt that says so.
ErrorEstimate error_of_black_picture();

/// The halves differ only by noise: their difference d has variance σ²/n₁ + σ²/n₂, and the picture has σ²/(n₁ + n₂), so
/// that n₁ n₂ / (n₁ + n₂)² d² is an unbiased estimate of the picture's variance, whatever the correlation of pixels.
/// These squares, divided by those of the true values, are averaged over the picture; the layer `standard_error` has
/// means over a few pixels. The true value is estimated by the mean of a window without edges (Kuwahara et al. 1976),
/// plus the part of the deviation from it that both halves share. Where rare bright samples dominate the variance, most
/// pixels are closer to the true value than it suggests: there the deviation from the window's mean is used.
///
/// The halves' estimates of the bias have independent noise, so that their product estimates the squared bias.
///
/// Depends only on the pictures, not on the number of threads.
MeasuredError measure_error(const PictureHalves& pictures);

/// Smooths one half's bias (HalfPicture::bias) as `MeasuredError::bias` is smoothed.
Image smoothed_bias(const Image& bias);

}  // namespace lanthorn
