// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "denoise/plane.h"
#include "math/vec.h"

namespace lanthorn::denoising {

inline constexpr std::size_t color_channels = 3;
using ColorPlanes = std::array<Plane, color_channels>;
/// A picture by each half of the passes.
using Halves = std::array<ColorPlanes, 2>;

/// What a regression explains light by: groups of three, each of one scale (albedo, normal, position).
struct FeaturePlanes {
  std::vector<Plane> values;
  std::vector<Plane> variances;  ///< of their noise
};

/// A picture whose patches are compared, and the variance of its noise, summed over channels.
struct Guide {
  ColorPlanes color;
  Plane variance;
};

struct RegressionSettings {
  int window;      ///< radius of the neighbourhood that a pixel's light is regressed over, pixels; at most 7
  int patch;       ///< radius of the patches that are compared, pixels; at most 3
  int stride;      ///< pixels between the centres of regressions
  float strength;  ///< patches that differ by so many standard deviations more than noise does weigh 1/e
};

/// Nonlinearly weighted first-order regression (Bitterli et al. 2016): around every centre, light is fitted by a linear
/// function of the features. Pixels weigh as much as their patches of the guide are like the centre's (Buades et al.
/// 2005), with differences as large as noise explains left out (Rousselle et al. 2012). Each fit predicts all pixels of
/// its neighbourhood, and a pixel is the weighted mean of its predictions.
ColorPlanes regress(const ColorPlanes& light, const Guide& guide, const FeaturePlanes& features,
                    const RegressionSettings& settings);

}  // namespace lanthorn::denoising
