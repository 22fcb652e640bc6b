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
  std::array<std::uint64_t, 2> passes{};  ///< of each half
};

/// What the halves say of the picture's error.
struct MeasuredError {
  ErrorEstimate estimate;
  Image standard_error;  ///< of R, G, B
  Image bias;            ///< signed, of R, G, B: the picture is too bright by so much
};

/// The halves differ by noise alone: their difference d has variance σ²/n₁ + σ²/n₂, and the picture has σ²/(n₁ + n₂),
/// so that n₁ n₂ / (n₁ + n₂)² d² estimates the picture's variance without bias, whatever the correlation of pixels.
/// Such squares, over those of the truth, are averaged over the picture; the layer `standard_error` has means of few
/// pixels. The truth is the mean of a window that has no edge (Kuwahara et al. 1976), and of the distance to it the
/// part that both halves have. Where spikes make the variance, most pixels are nearer to the truth than it says: there
/// the distance to the mean of the window counts.
///
/// The halves' estimates of the bias have independent noise, so that their product estimates the square of the bias.
///
/// A function of the pictures, the same for any number of threads.
MeasuredError measure_error(const PictureHalves& pictures);

}  // namespace lanthorn
