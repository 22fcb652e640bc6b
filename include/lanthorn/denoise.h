// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Removes noise from pictures, layer by layer, by the statistics of their own samples.
#pragma once

#include "lanthorn/error_estimate.h"
#include "lanthorn/image.h"

namespace lanthorn {

/// A picture and what it is without its noise.
struct DenoisedPicture {
  /// All channels of the noisy picture; then denoised.R, G, B, the sum of the denoised layers of light, and these:
  /// denoised.direct.R, denoised.caustic.R and so on; and denoised.error.R, G, B, one standard error of denoised.R, G,
  /// B.
  Image picture;
  ErrorEstimate error;  ///< of the sum
};

/// True if the picture has what `denoise` needs: layers of light, features, and the noise of both
/// (`with_noise`).
bool can_denoise(const Image& picture);

/// Denoises each layer of light by itself, so that layers still add up, and a caustic keeps its edges where the light
/// beside it is smooth. Light is regressed over albedo, normal and position in neighbourhoods of like pixels; the
/// difference of the two halves of the passes is the noise (Bitterli et al. 2016, "Nonlinearly Weighted First-order
/// Regression for Denoising Monte Carlo Renderings"). Pixels that are not finite count as black.
///
/// A function of the picture, the same for any number of threads. A picture of 1024 x 1024 pixels takes about 1.6 GB;
/// larger ones are done in tiles of this size. Throws Error if `can_denoise` is false.
DenoisedPicture denoise(const Image& picture);

/// R, G, B of the picture without its noise, for a look while a render goes on: in a tenth of the time of `denoise`,
/// with more of the noise left. `color` is denoised as one layer, so there are no layers that add up to it, and a
/// caustic is less sharp. Same bytes for any number of threads; throws as `denoise` does.
Image preview_without_noise(const Image& picture);

/// The picture as it is shown and saved without its noise: the layers of light and `color` are the denoised ones, and
/// neither `noise` nor `denoised` layers are left. `picture` has those of `denoise`.
Image with_denoised_light(const Image& picture);

}  // namespace lanthorn
