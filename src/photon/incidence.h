// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The factor |cos_s| / |cos_g| of density estimates with shading normals (Veach 1997, section 5.3.2), split between the
// photon and the gather point.
//
// The number of photons of a beam along ω that land on a surface is proportional to the geometric cosine; their light
// is scattered in proportion to the shading cosine. A density estimate uses photons from neighbouring facets. If its
// own facet is nearly parallel to ω and a neighbouring one is not, the quotient is unbounded for photons that are not
// rare, and it has no finite mean. Therefore the division is split: the power of a photon at grazing incidence is
// multiplied by κ / cos_g of its facet, and the gather point divides by the larger of its own cos_g and κ. If both
// facets have the same cosine, which is the limit of a shrinking radius, the product is cos_s / cos_g.
#pragma once

#include <algorithm>
#include <cmath>

namespace lanthorn {

/// κ: below this cosine a photon's incidence counts as grazing.
inline constexpr float grazing_cosine = 0.1f;

/// Factor of a photon's power. `geometric` is |cos| of its incidence on its own facet.
inline float grazing_gain(float geometric) {
  constexpr float least = 1e-4f;  // bounds the factor; darkens the share κ 1e-4 of a beam's light that lands below it
  return geometric < grazing_cosine ? grazing_cosine / std::max(least, geometric) : 1.0f;
}

/// Factor, at a gather point, of a photon whose power includes `grazing_gain`. `shading`, `geometric`: |cos| of the
/// photon's direction to the gather point's normals.
inline float incidence_ratio(float shading, float geometric) { return shading / std::max(grazing_cosine, geometric); }

}  // namespace lanthorn
