// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/emission_choice.h"

#include "base/parameters.h"
#include "photon/learned_emission.h"
#include "photon/projection_map.h"

namespace lanthorn {

EmissionChoice emission_choice(const Parameters& parameters) {
  return choice<EmissionChoice, 3>(parameters, "emission",
                                   {{{"power", EmissionChoice::power},
                                     {"projected", EmissionChoice::projected},
                                     {"learned", EmissionChoice::learned}}});
}

std::optional<EmissionGuide> choose_emission(EmissionChoice choice, PhotonUse use, const RenderJob& job) {
  switch (choice) {
    case EmissionChoice::power:
      break;
    case EmissionChoice::projected:
      return make_projection_map(job.scene,
                                 use == PhotonUse::caustics ? PhotonTarget::specular : PhotonTarget::surfaces);
    case EmissionChoice::learned:
      return learn_emission(job, use);
  }
  return {};
}

}  // namespace lanthorn
