// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/guides/emission_choice.h"

#include <fmt/format.h>

#include <utility>

#include "base/parameters.h"
#include "photon/gather/pilot_radius.h"
#include "photon/guides/learned_emission.h"
#include "photon/guides/projection_map.h"

namespace lanthorn {

EmissionChoice emission_choice(const Parameters& parameters) {
  return choice<EmissionChoice, 4>(parameters, "emission",
                                   {{{"auto", EmissionChoice::automatic},
                                     {"power", EmissionChoice::power},
                                     {"projected", EmissionChoice::projected},
                                     {"learned", EmissionChoice::learned}}});
}

Emission choose_emission(EmissionChoice choice, PhotonUse use, const RenderJob& job, MediumRecords media) {
  const bool in_media = media != MediumRecords::none && job.scene.has_scattering_media();
  switch (choice) {
    case EmissionChoice::automatic: {
      // Learning takes a second or more and can gain no more than the photons that it aims at the view.
      constexpr double few = 0.02;
      const double in_view = photons_in_view(job);
      if (in_view >= few) break;
      constexpr double unimportant = 0.025;
      LearnedEmission learned = learn_emission(job, use, in_media);
      if (learned.share < unimportant) break;
      const std::string share = in_view > 1e-6 ? fmt::format("one photon in {:.0f}", 1 / in_view) : "almost no photon";
      return {std::move(learned.guide),
              fmt::format("{} lands in view: photons start where light paths that do have been found "
                          "(--set emission=power: everywhere){}",
                          share, use == PhotonUse::merging ? "" : "; auto needs fewer")};
    }
    case EmissionChoice::power:
      break;
    case EmissionChoice::projected: {
      const PhotonTarget landings = in_media ? PhotonTarget::surfaces_and_media : PhotonTarget::surfaces;
      const PhotonTarget target = use == PhotonUse::caustics ? PhotonTarget::specular : landings;
      return {LightGuide{make_projection_map(job.scene, target)}, {}};
    }
    case EmissionChoice::learned:
      return {learn_emission(job, use, in_media).guide, {}};
  }
  return {};
}

}  // namespace lanthorn
