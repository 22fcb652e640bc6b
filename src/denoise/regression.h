// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
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

}  // namespace lanthorn::denoising
