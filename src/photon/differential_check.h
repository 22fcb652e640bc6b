// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "index/point_index.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Differential checking (Jensen 1996, "Global Illumination using Photon Maps"): how many of the nearest photons an
/// estimate should look at. `nearest` in order of distance, with the places of their `light`. Photons are added from
/// the nearest on, each time by the estimate of a constant kernel; where that has only grown, or only fallen, by more
/// than the share `threshold` since some photon, the disc has come to other light, and ends with that photon. At least
/// `least_checked` remain. Noise may end a disc too, the more often the lower the threshold.
std::size_t settled_count(std::span<const Neighbour> nearest, std::span<const Spectrum> light, float threshold);
inline constexpr std::size_t least_checked = 8;

}  // namespace lanthorn
