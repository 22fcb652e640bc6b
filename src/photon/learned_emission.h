// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "photon/emission_choice.h"

namespace lanthorn {

/// Learns where the photons start that matter to the picture (after Hachisuka & Jensen 2011, "Robust Adaptive Photon
/// Tracing Using Photon Path Visibility", and Grittmann, Pérard-Gayot, Slusallek & Křivánek 2018, "Efficient Caustic
/// Rendering with Lightweight Photon Mapping"). Pilot eye paths leave hit points on what the picture shows. In some
/// rounds photons are traced, from all over the lights at first, then by what has been learned; each hit point shares
/// among the photons around it, by their flux, a credit of what photons make of the pixel's light, so that all of the
/// picture counts alike. The numbers of emission are subdivided where paths of much credit have started, and where
/// projection maps say that mirrors or glass are. A part of the photons always starts as if nothing were known: what
/// the pilot has missed is only rarer.
EmissionGuide learn_emission(const RenderJob& job, PhotonUse use);

}  // namespace lanthorn
