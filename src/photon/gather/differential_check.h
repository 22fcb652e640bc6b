// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "index/point_index.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Differential checking (Jensen 1996, "Global Illumination using Photon Maps"): the number of nearest photons that an
/// estimate should use. `nearest` is sorted by distance; its slots index `light`. The function evaluates the estimate
/// of a constant kernel while it adds photons from the nearest on. Where the estimate has grown monotonically, or
/// fallen monotonically, by more than the share `threshold` since some photon, the disc has reached an area of
/// different light and is cut at that photon. At least `least_checked` photons remain. Noise can cut a disc too, more
/// often for lower thresholds.
std::size_t settled_count(std::span<const Neighbour> nearest, std::span<const Spectrum> light, float threshold);
inline constexpr std::size_t least_checked = 8;

}  // namespace lanthorn
