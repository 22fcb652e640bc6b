// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Spread and coherence of the walks that scatter at a vertex.
#pragma once

#include "medium/phase.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// Share of Henyey & Greenstein's phase function that counts as wide, in analogy to `spread_of_lobe`: 1 / alpha² is the
/// ratio of its second moment to the second moment of isotropic scattering, (1 + g²) / (1 - g²)². 1 for isotropic
/// scattering.
inline float spread_of_phase(const HenyeyGreenstein& hg) {
  const float g2 = sqr(hg.g), alpha2 = sqr(1 - g2) / (1 + g2);
  return alpha2 / (alpha2 + sqr(half_spread_alpha) * (1 - alpha2));
}

/// Factor in [0,1] by which MIS weights count merging in media after the eye path has scattered: near 1 after narrow
/// lobes, and 0 after wide ones, where photons are not looked up.
inline float coherence_of_spread(float spread) {
  constexpr float wide = 0.9f;
  return spread < wide ? 1 - spread : 0.0f;
}
/// Coherence of a closure's non-delta lobes. It depends on the closure alone, so that light walks can compute it, too.
inline float coherence(const Bsdf& bsdf) {
  const LobeWeights lobes = lobe_weights(bsdf, Vec3(0, 0, 1));
  return lobes.diffuse > 0 || is_fibre(bsdf) ? 0.0f : coherence_of_spread(spread_of_lobe(lobes.alpha));
}
inline float coherence(const HenyeyGreenstein& phase) { return coherence_of_spread(spread_of_phase(phase)); }

}  // namespace lanthorn
