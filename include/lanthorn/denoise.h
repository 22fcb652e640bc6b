// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Denoises rendered pictures layer by layer, guided by the sample statistics that the renderer saved with them.
#pragma once

#include <functional>
#include <optional>

#include "lanthorn/error_estimate.h"
#include "lanthorn/image.h"
#include "lanthorn/state.h"

namespace lanthorn {

/// A noisy picture with its denoised version.
struct DenoisedPicture {
  /// All channels of the noisy picture, followed by denoised.R, denoised.G, denoised.B (the sum of the denoised light
  /// layers), the denoised light layers themselves (denoised.direct.R, denoised.caustic.R, ...), and denoised.error.R,
  /// denoised.error.G, denoised.error.B (one standard error of denoised.R, .G, .B).
  Image picture;
  ErrorEstimate error;  ///< of denoised.R, .G, .B
};

/// True if the picture has the layers that `denoise` needs: light, features, and the noise of both (those that
/// `with_noise` adds).
bool can_denoise(const Image& picture);

/// Denoises each light layer separately: the denoised layers still add up to the picture, and a caustic keeps its edges
/// where the light beside it is smooth. Regresses light on albedo, normal and position over neighbourhoods of similar
/// pixels; the difference between the two halves of the passes estimates the noise (Bitterli et al. 2016, "Nonlinearly
/// Weighted First-order Regression for Denoising Monte Carlo Renderings"). Non-finite pixels count as black.
///
/// The result does not depend on the number of threads. Memory: about 1.6 GB for 1024 x 1024 pixels; larger pictures
/// are processed in tiles of that size. Throws Error if `can_denoise` is false.
///
/// `around`: the same render with pixels around a crop (`with_margin`), so that the crop's border is denoised as well
/// as its inside. Throws Error if `around` does not contain the picture.
DenoisedPicture denoise(const Image& picture, const std::optional<Image>& around = {});

/// The margin (ViewOptions::margin) beyond which pixels around a crop hardly matter.
inline constexpr int denoising_margin = 24;

/// For StopRule::error_of: estimates the error of the denoised picture. While the noisy picture's error is more than 8
/// times `limit`, which denoising cannot make up for, returns that instead.
std::function<ErrorEstimate(const RenderState&)> denoised_error(double limit);

/// Denoised R, G, B, for display while a render is in progress: ten times as fast as `denoise`, but leaves more noise.
/// Treats `color` as a single layer, so there are no denoised layers that add up to it, and caustics are less sharp.
/// The result does not depend on the number of threads. Throws Error as `denoise` does.
Image preview_without_noise(const Image& picture);

/// The denoised picture as it is shown and saved: its light layers and `color` are the denoised ones; the `noise` and
/// `denoised` layers are removed. `picture` is a result of `denoise`.
Image with_denoised_light(const Image& picture);

}  // namespace lanthorn
