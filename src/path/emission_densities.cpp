// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/emission_densities.h"

#include "light/light_sampler.h"

namespace lanthorn {

EmissionDensities::EmissionDensities(const Scene& scene, const EmissionGuide* guide)
    : scene_(scene),
      guide_(guide),
      has_curves_(scene.statistics().curves > 0),
      of_lights_(emission_probabilities(scene.lights(), guide)) {}

}  // namespace lanthorn
