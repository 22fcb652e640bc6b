// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The default method: vertex connection and merging whose numbers of samples a pilot chooses for each part of the
// picture (Grittmann, Yazici, Georgiev & Slusallek 2022, "Efficiency-aware multiple importance sampling for
// bidirectional rendering algorithms").
//
// 1. pilot.h        a few passes over a grid of pixels; EyePathLog has each contribution with its densities
// 2. moments.h      the second moments that each candidate would have had
// 3. choice.cpp     the candidates with the least product of variance and work, block by block; what it tells the user
#include "integrators/auto/auto.h"

#include "base/parameters.h"
#include "integrators/auto/pilot.h"

namespace lanthorn {

IntegratorInfo vcm_info();

void plan_effort(const RenderJob& job, const VcmSettings& settings, VcmPreparation& prepared) {
  prepared.effort = Effort(pilot_light_paths(job));
  EffortChoice choice = choose_effort(job, measure_candidates(job, settings, prepared));
  prepared.effort = std::move(choice.effort);
  prepared.remark = choice.report.summary;
  prepared.findings = std::move(choice.report);
}

IntegratorInfo auto_info() {
  // The pilot may choose up to four times as many light paths: about one for each pixel of 1920 x 1080, which bounds
  // the memory of large pictures.
  constexpr LightPathRange light_path_range{.fewest = 10'000, .most = 1u << 19};
  return {"auto",
          "vcm with the light paths, connections and merges that a pilot finds best for each part of the picture",
          "Grittmann et al. 2022",
          {},
          [](const Parameters&) {
            const IntegratorInfo vcm = vcm_info();
            VcmSettings settings(Parameters(vcm.parameters, {}, vcm.name), {.connections = true, .merging = true});
            settings.plan_effort = plan_effort;
            return make_vertex_connection_and_merging(settings);
          },
          light_path_range};
}

}  // namespace lanthorn
