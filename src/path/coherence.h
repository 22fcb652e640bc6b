// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// How far walks that scatter at a vertex spread, and how well they stay together.
#pragma once

#include "medium/phase.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// Share of the light of Henyey & Greenstein's phase function that spreads widely. Its second moment is (1 + g²) / (1 -
/// g²)² times that of an even one: as 1 / alpha² for a lobe (`spread_of_lobe`). 1 if the medium scatters evenly.
inline float spread_of_phase(const HenyeyGreenstein& hg) {
  const float g2 = sqr(hg.g), alpha2 = sqr(1 - g2) / (1 + g2);
  return alpha2 / (alpha2 + sqr(half_spread_alpha) * (1 - alpha2));
}

/// Factor in [0,1] by which weights count merging in media beyond a scattering of the eye path: near 1 for narrow
/// lobes. It is 0 for wide ones, so that photons are not searched there.
inline float coherence_of_spread(float spread) {
  constexpr float wide = 0.9f;
  return spread < wide ? 1 - spread : 0.0f;
}
/// The factor of a closure's non-delta lobes. It depends on the closure alone, so that light walks know it, too.
inline float coherence(const Bsdf& bsdf) {
  const LobeWeights lobes = lobe_weights(bsdf, Vec3(0, 0, 1));
  return lobes.diffuse > 0 || is_fibre(bsdf) ? 0.0f : coherence_of_spread(spread_of_lobe(lobes.alpha));
}
inline float coherence(const HenyeyGreenstein& phase) { return coherence_of_spread(spread_of_phase(phase)); }

}  // namespace lanthorn
