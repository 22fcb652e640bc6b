// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "photon/guides/emission_choice.h"

namespace lanthorn {

/// A learned guide, and how much photons contribute to the picture.
struct LearnedEmission {
  std::optional<LightGuide> guide{};  ///< empty where there is nothing to learn
  double share = 0;  ///< fraction of the light at the visible surfaces that photons contribute, mean over the full film
};

/// Learns where photons start that contribute to the picture (after Hachisuka & Jensen 2011, "Robust Adaptive Photon
/// Tracing Using Photon Path Visibility", and Grittmann, Pérard-Gayot, Slusallek & Křivánek 2018, "Efficient Caustic
/// Rendering with Lightweight Photon Mapping").
/// 1. Pilot eye paths through the full film, whatever part of it is rendered, store hit points on visible surfaces.
/// 2. Several rounds trace photons: the first from all over the lights, later ones by the guide learned so far. Each
///    hit point distributes a credit among the photons around it, in proportion to their flux. The credit is the share
///    of the pixel's light that photons contribute, so that dark and bright pixels count alike.
/// 3. The domain of the numbers that sample emission is subdivided where paths with much credit have started, and where
///    projection maps find mirrors or glass.
/// `in_media`: photons that scatter in media count as well.
/// There is no guide where photons cannot add light: no light has power, or the visible surfaces are convex.
/// A fixed share of the photons ignores the guide, so that light which the pilot has missed is sampled too, if rarely.
LearnedEmission learn_emission(const RenderJob& job, PhotonUse use, bool in_media = false);

}  // namespace lanthorn
