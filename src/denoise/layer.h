// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Denoises a single light layer, by regression (regression.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "film/plane.h"
#include "math/vec.h"

namespace lanthorn::denoising {

inline constexpr std::size_t color_channels = 3;
using ColorPlanes = std::array<Plane, color_channels>;
/// The picture of each half of the passes.
using Halves = std::array<ColorPlanes, 2>;

/// Regressors in groups of three, each group with one scale (albedo, normal, position).
struct FeaturePlanes {
  std::vector<Plane> values;
  std::vector<Plane> variances;  ///< of the features' noise
};

/// A picture whose patches determine the weights, and the variance of its noise, summed over channels.
struct Guide {
  ColorPlanes color;
  Plane variance;
};

struct RegressionSettings {
  int window;      ///< radius in pixels of the neighbourhood over which a pixel's light is regressed; at most 7
  int patch;       ///< radius in pixels of the compared patches; at most 3
  int stride;      ///< pixels between the centres of regressions; at least 2
  float strength;  ///< weight 1/e at this many standard deviations beyond the noise
};

/// Nonlinearly weighted first-order regression (Bitterli et al. 2016): around each centre, a linear function of the
/// features is fitted to the light. Pixels are weighted by the similarity of their patches in the guide to the centre's
/// (Buades et al. 2005), where differences explained by noise are discounted (Rousselle et al. 2012). Each fit predicts
/// all pixels of its neighbourhood; a pixel is the weighted mean of its predictions.
ColorPlanes regress(const ColorPlanes& light, const Guide& guide, const FeaturePlanes& features,
                    const RegressionSettings& settings);

/// Both halves, with the weights of one guide.
Halves regress(const Halves& light, const Guide& guide, const std::array<FeaturePlanes, 2>& features,
               const RegressionSettings& settings);

using Shares = std::array<float, 2>;  ///< fraction of the passes in each half; they sum to 1

/// The mean over all passes.
Plane mean_of(const Halves& light, std::size_t channel, const Shares& shares);

/// Normalisation of errors.
struct ErrorScale {
  Plane light2;                                          ///< square of the light around a pixel
  float white = std::numeric_limits<float>::infinity();  ///< brighter light counts as this bright
};

/// Estimate of the squared error of the mean of `result`, divided by `scale`, per pixel: a mean over channels, unbiased
/// but noisy and possibly negative. Half a of the result has the noise of half a of `light`; half b of the light
/// differs from it by the error of a and by its own noise, whose variance follows from the difference of the halves.
Plane squared_error(const Halves& light, const Halves& result, const Shares& shares, const ErrorScale& scale);

/// The same estimate by half a of the result alone and by half b alone, which differ in noise: that of half b of the
/// light, and that of half a. Their mean, weighted by `shares`, is `squared_error`.
std::array<Plane, 2> squared_errors(const Halves& light, const Halves& result, const Shares& shares,
                                    const ErrorScale& scale);

/// Data that all layers of a picture share, at one resolution.
struct Surroundings {
  std::array<FeaturePlanes, 2> features;  ///< for each half
  ColorPlanes demodulation;               ///< factors that remove most of the texture from light
  ErrorScale scale;
};

/// The surroundings at half the resolution.
Surroundings halved(const Surroundings& surroundings);

/// Denoises a feature of three channels and adds it with its variance to `features`. `halves` are the feature's.
void add_features(const Halves& halves, const Shares& shares, std::array<FeaturePlanes, 2>& features);

/// As `add_features`, without denoising.
void add_noisy_features(const Halves& halves, const Shares& shares, std::array<FeaturePlanes, 2>& features);

struct DenoisedLayer {
  Halves light;
  /// What `squared_error` of `light` leaves out, because the candidates of least estimated error were selected: each
  /// half's estimate of the error of what the other half selects is free of this. Smooth.
  Plane optimism;
};

/// Both halves of a layer, denoised. `levels`: surroundings at full resolution, half, a quarter and so on.
///
/// At each level, each half is regressed with weights from patches of the other half, after removal of texture; low
/// frequencies are taken from coarser levels, which reach farther and average noise that neighbouring pixels share, as
/// photons within a kernel do. The result then guides a second regression, since it shows edges better. For each pixel,
/// cross-validation selects the result of least error, which may be the unfiltered light.
DenoisedLayer denoise_layer(const Halves& light, const Shares& shares, const std::vector<Surroundings>& levels);

/// Only the first regression, with small windows: much faster, but leaves more noise.
Halves preview_layer(const Halves& light, const Shares& shares, const std::vector<Surroundings>& levels);

}  // namespace lanthorn::denoising
