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
  power,      ///< in proportion to emitted power
  projected,  ///< in directions where a target can be hit (projection_map.h)
  learned     ///< where photons start that contribute to the picture (learned_emission.h)
};

/// The parameter "emission".
inline ParameterInfo emission_info(const char* default_choice) {
  return {"emission", default_choice,
          "where photons start: power (by emitted power), projected (where they can hit a surface that matters), or "
          "learned (where photons start that contribute to the picture)"};
}
EmissionChoice emission_choice(const Parameters& parameters);

/// The use that a method makes of its photons.
enum class PhotonUse : std::uint8_t {
  indirect,  ///< indirect light at visible surfaces; direct light is found by other techniques
  caustics,  ///< caustics alone at visible surfaces
  gathering  ///< as `indirect`, and all light at the ends of gather rays
};

/// The emission guide for these photons. Empty for `power`. Depends on scene, seed, photon count and window only.
std::optional<EmissionGuide> choose_emission(EmissionChoice choice, PhotonUse use, const RenderJob& job);

}  // namespace lanthorn
