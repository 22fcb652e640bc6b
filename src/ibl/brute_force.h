// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What the maps should hold, from all texels of the image, to measure their errors by.
#pragma once

#include <vector>

#include "ibl/environment.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

/// The texels of a cube map of this size that are checked: that which faces the brightest texel of the environment
/// first, the others spread over the map.
std::vector<CubeTexel> checked_texels(const Environment& environment, int size, int count);

/// Sums of the cosine over the environment, normalised.
std::vector<Spectrum> integrate_cosine(const Environment& environment, const std::vector<Direction>& directions);
/// The same of a GGX lobe. Texels that are wide for it are divided.
std::vector<Spectrum> integrate_lobe(const Environment& environment, const std::vector<Direction>& directions,
                                     float alpha, LobeWeight weight);

/// R and G of `brdf_table` by a sum over all normals of the microsurface, where the table takes visible ones.
struct BrdfSums {
  double scale = 0, bias = 0;
};
BrdfSums integrate_brdf(double cos, double alpha);

MapError map_error(const std::vector<Spectrum>& values, const std::vector<Spectrum>& truth);

}  // namespace lanthorn
