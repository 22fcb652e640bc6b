// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// From the credit of light paths to an emission guide.
#pragma once

#include <optional>
#include <vector>

#include "light/emission_guide.h"
#include "photon/guides/credit_round.h"
#include "scene/scene.h"

namespace lanthorn {

/// The guide that starts light paths where `starts` have credit: lights by their credit, and for each light a
/// subdivision of the numbers that sample its emission. `unknown_share`: of photons that ignore the credit.
EmissionGuide guide_from(const Scene& scene, std::vector<CreditedStart> starts, float unknown_share,
                         const std::optional<AimedDisks>& disks);

}  // namespace lanthorn
