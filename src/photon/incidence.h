// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How flux that lands on a geometric surface is scattered by shading normals at another point of it.
//
// Photons of a beam along ω land in proportion to the geometric cosine where they land, and what they bring to a point
// counts by the shading cosine there: cos_s / cos_g (Veach 1997, section 5.3.2). A density estimate takes photons of
// the facets around for those of its own, and where its own lies nearly along ω and another does not, the quotient
// grows without bounds for photons that are not rare: it has no finite mean. So the photon brings part of it. One that
// grazes carries κ / cos_g of its own facet, and the point divides by its own cos_g or κ, whichever is larger. The
// product is cos_s / cos_g where both cosines are the same, as they are when the radius shrinks.
#pragma once

#include <cmath>

namespace lanthorn {

/// κ: photons graze below this cosine.
inline constexpr float grazing_cosine = 0.1f;

/// Factor of a photon's power; `geometric`: |cos| under which it lands.
inline float grazing_gain(float geometric) {
  constexpr float least = 1e-4f;  // a share of κ 1e-4 of a beam's light lands below, and is darkened
  return geometric < grazing_cosine ? grazing_cosine / std::fmax(geometric, least) : 1.0f;
}

/// Factor of light that a photon with that gain brings to a point with these |cos| of its direction.
inline float incidence_ratio(float shading, float geometric) { return shading / std::fmax(geometric, grazing_cosine); }

}  // namespace lanthorn
