// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The second pass of reverse photon mapping (Havran, Herzog & Seidel 2005): eye paths are traced first and their ends
// are stored as reverse photons; then each photon adds its light to the reverse photons within its radius.
#pragma once

#include "integrators/photonmap/reverse_photons.h"
#include "integrators/photonmap/two_pass.h"

namespace lanthorn {

/// Adds the pass to the film, in blocks of pixels whose reverse photons fit into about the `memory` bytes of the
/// settings.
PassReport gather_in_reverse(const RenderJob& job, const TwoPassSettings& settings, const TwoPassMaps& maps,
                             RadiusRule radii, std::uint32_t pass, const FilmPass& film, const PhaseObserver& begin);

}  // namespace lanthorn
