// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/parameters.h"
#include "path/render_job.h"
#include "photon/guides/guide_photons.h"
#include "photon/photon.h"

namespace lanthorn {

/// Where the light paths of a method start.
enum class EmissionChoice : std::uint8_t {
  automatic,  ///< learned if few photons land in view, otherwise by power
  power,      ///< in proportion to emitted power
  projected,  ///< in directions where a target can be hit (projection_map.h)
  learned     ///< where photons start that contribute to the picture (learned_emission.h)
};

/// The parameter "emission".
inline ParameterInfo emission_info(const char* default_choice) {
  return {"emission", default_choice,
          "where photons start: power (by emitted power), projected (where they can hit a surface or a medium that "
          "matters), learned (where photons start that contribute to the picture), or auto (learned if few photons "
          "land in view, else power)"};
}
EmissionChoice emission_choice(const Parameters& parameters);

/// The use that a method makes of its photons.
enum class PhotonUse : std::uint8_t {
  indirect,  ///< indirect light at visible surfaces; direct light is found by other techniques
  merging,   ///< as `indirect`, but without guided directions, because MIS weights need the densities of light paths
  caustics,  ///< caustics alone at visible surfaces
  gathering  ///< as `indirect`, and all light at the ends of gather rays
};

/// Where the photons of a method start, and why.
struct Emission {
  std::optional<LightGuide> guide{};  ///< empty: by power
  std::string remark{};               ///< on an automatic choice of a guide, for the user

  const LightGuide* get() const { return guide ? &*guide : nullptr; }
  const EmissionGuide* starts() const { return guide ? &guide->emission : nullptr; }
};

/// Chooses where photons start. `media`: their records in scattering media. Depends on scene, seed, photon count and
/// view only.
Emission choose_emission(EmissionChoice choice, PhotonUse use, const RenderJob& job,
                         MediumRecords media = MediumRecords::none);

}  // namespace lanthorn
