// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "light/emission_guide.h"
#include "light/light_sampler.h"
#include "scene/scene.h"

namespace lanthorn {

/// Densities with which light paths start, as the MIS weights of bidirectional methods use them.
///
/// Where a guide makes light paths denser, that counts for all light except direct light: paths from a light by one
/// surface to the lens. Next-event estimation finds direct light with little noise, however many light paths arrive on
/// the surface; the balance heuristic, which knows only densities, would prefer the light paths. Where a guide makes
/// light paths sparser, that always counts. Weights are valid as long as all techniques use the same function of the
/// path.
///
/// Scenes with curves are another exception: there no path counts as denser. A flat curve shows each ray another
/// ribbon, so a light path and an eye path that meet on it see different normals, and their weights do not quite sum to
/// 1. When weights counted the guide, indirect light on hair was 27 % too bright.
class EmissionDensities {
 public:
  /// `guide` of the light paths, null if they have none; must outlive this.
  explicit EmissionDensities(const Scene& scene, const EmissionGuide* guide = nullptr)
      : scene_(scene),
        guide_(guide),
        has_curves_(scene.statistics().curves > 0),
        of_lights_(emission_probabilities(scene.lights(), guide)) {}

  /// Probability with which a light path begins on each light, as in PhotonAllocation.
  const std::vector<float>& of_lights() const { return of_lights_; }
  /// Factor that turns `pdf_emission` into the density of light paths, for all but direct light. `origin`: where the
  /// ray starts; for far lights any point of it.
  float factor(std::uint32_t light, const EmitterHit& origin, const Direction& direction) const {
    return has_curves_ ? factor_of_direct_light(light, origin, direction) : guided(light, origin, direction, infinity);
  }
  /// The same for direct light. Evaluates the guide only until it is known to be denser than no guide.
  float factor_of_direct_light(std::uint32_t light, const EmitterHit& origin, const Direction& direction) const {
    return of_direct_light(light, guided(light, origin, direction, 1));
  }
  /// The factor for direct light, if the factor for other light is `factor`.
  float of_direct_light(std::uint32_t light, float factor) const { return std::min(of_lights_[light], factor); }

 private:
  // `enough`: see `guided_density`.
  float guided(std::uint32_t light, const EmitterHit& origin, const Direction& direction, float enough) const {
    const float p = of_lights_[light];
    if (guide_ == nullptr) return p;
    return p * guided_density(*guide_, scene_.lights()[light], light, origin, direction, enough);
  }

  Scene scene_;
  const EmissionGuide* guide_;
  bool has_curves_;
  std::vector<float> of_lights_;
};

}  // namespace lanthorn
