// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Denoises rendered pictures layer by layer, guided by the sample statistics that the renderer saved with them.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

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

/// Estimates the error of the denoised picture while it is rendered, for StopRule::error_of (by std::ref).
class DenoisedLooks {
 public:
  /// A picture that reached the limit, so that it need not be denoised again once the render has ended.
  struct Found {
    std::uint64_t passes = 0;  ///< of the state
    ErrorEstimate error;       ///< of the noisy picture
    DenoisedPicture denoised;
  };

  explicit DenoisedLooks(double limit) : limit_(limit) {}

  /// Returns the noisy picture's error, without denoising, while that is more than 8 times the limit: denoising cannot
  /// make up for so much.
  ErrorEstimate operator()(const RenderState& state);
  /// The last look's picture, if its error is below the limit. Can be taken once.
  std::optional<Found> take() { return std::exchange(found_, std::nullopt); }

 private:
  double limit_;
  std::optional<Found> found_;
};

/// Denoised R, G, B, for display while a render is in progress: ten times as fast as `denoise`, but leaves more noise.
/// Treats `color` as a single layer, so there are no denoised layers that add up to it, and caustics are less sharp.
/// The result does not depend on the number of threads. Throws Error as `denoise` does.
Image preview_without_noise(const Image& picture);

/// The denoised picture as it is shown and saved: its light layers and `color` are the denoised ones; the `noise` and
/// `denoised` layers are removed. `picture` is a result of `denoise`.
Image with_denoised_light(const Image& picture);

}  // namespace lanthorn
