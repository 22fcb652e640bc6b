// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Removes the noise of one layer of light.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "denoise/regression.h"

namespace lanthorn::denoising {

using Shares = std::array<float, 2>;  ///< of the passes in each half; their sum is 1

/// The mean over all passes.
Plane mean_of(const Halves& light, std::size_t channel, const Shares& shares);

/// What errors are relative to.
struct ErrorScale {
  Plane light2;                                          ///< square of the light around a pixel
  float white = std::numeric_limits<float>::infinity();  ///< light that is brighter counts as this bright
};

/// The squared error of the mean of `result`, over `scale`, per pixel: a mean over channels that is right on average,
/// but has much noise and may be negative. Half a of the result has the noise of half a of `light`, and half b of the
/// light differs from it by the error of a and by its own noise, whose variance is known from the halves' difference.
Plane squared_error(const Halves& light, const Halves& result, const Shares& shares, const ErrorScale& scale);

/// What all layers of a picture share, at one resolution.
struct Surroundings {
  std::array<FeaturePlanes, 2> features;  ///< of each half
  ColorPlanes demodulation;               ///< factors that take most of the texture from light
  ErrorScale scale;
};

/// Half the resolution.
Surroundings halved(const Surroundings& surroundings);

/// Features of three channels without their noise, and its variance, added to `features`. `halves` are theirs.
void add_features(const Halves& halves, const Shares& shares, std::array<FeaturePlanes, 2>& features);

/// The same of features as they are.
void add_noisy_features(const Halves& halves, const Shares& shares, std::array<FeaturePlanes, 2>& features);

/// Both halves of a layer without their noise. `levels`: surroundings at the resolution of the picture, half of it, a
/// quarter and so on.
///
/// Each half is regressed by patches of the other, without their texture, at each level, and low frequencies are taken
/// from coarser levels: these reach farther, and know noise that neighbouring pixels share, as photons within a kernel
/// do. Then the result is the guide of a second regression, since it shows edges better. For each pixel, the result of
/// least error by cross-validation is taken, which may be the light as it was.
Halves denoise_layer(const Halves& light, const Shares& shares, const std::vector<Surroundings>& levels);

/// The same by the first regression alone, over small windows: much faster, with more of the noise left.
Halves preview_layer(const Halves& light, const Shares& shares, const std::vector<Surroundings>& levels);

}  // namespace lanthorn::denoising
