// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reference values of the maps, from all texels of the image, to measure the maps' errors.
#pragma once

#include <vector>

#include "ibl/environment.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

/// The texels to check in a cube map of this size: first the one that faces the brightest texel of the environment,
/// then texels spread over the map.
std::vector<CubeTexel> checked_texels(const Environment& environment, int size, int count);

/// Cosine-weighted sums over the environment, normalised.
std::vector<Spectrum> integrate_cosine(const Environment& environment, const std::vector<Direction>& directions);
/// The same for a GGX lobe. Texels that are wide relative to the lobe are subdivided.
std::vector<Spectrum> integrate_lobe(const Environment& environment, const std::vector<Direction>& directions,
                                     float alpha, LobeWeight weight);

/// R and G of `brdf_table`, by summing over all normals of the microsurface instead of sampling visible ones.
struct BrdfSums {
  double scale = 0, bias = 0;
};
BrdfSums integrate_brdf(double cos, double alpha);

MapError map_error(const std::vector<Spectrum>& values, const std::vector<Spectrum>& truth);

}  // namespace lanthorn
