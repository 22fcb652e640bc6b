// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "base/parameters.h"
#include "light/emission_guide.h"
#include "path/render_job.h"

namespace lanthorn {

/// Where the light paths of a method start.
enum class EmissionChoice : std::uint8_t {
  power,      ///< all light alike
  projected,  ///< where something is to be met (projection_map.h)
  learned     ///< where what was learned to matter to the picture has started
};

/// The parameter "emission".
inline ParameterInfo emission_info(const char* default_choice) {
  return {"emission", default_choice,
          "where photons start: power (all light alike), projected (where they can meet something), or learned (where "
          "those start that the picture shows)"};
}
EmissionChoice emission_choice(const Parameters& parameters);

/// What photons are for.
enum class PhotonUse : std::uint8_t {
  indirect,  ///< read where the picture shows a surface; direct light is found otherwise
  caustics,  ///< the same of caustics alone
  gathering  ///< as `indirect`, and all of them read where gather rays end
};

/// The guide for these photons; nothing if all light is alike. Depends on scene, seed, photon count and window only.
std::optional<EmissionGuide> choose_emission(EmissionChoice choice, PhotonUse use, const RenderJob& job);

}  // namespace lanthorn
