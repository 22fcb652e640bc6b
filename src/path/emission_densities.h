// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "light/emission_guide.h"
#include "scene/scene.h"

namespace lanthorn {

/// How densely light paths start where, as the weights of bidirectional methods see it.
///
/// Where a guide makes light paths denser, that counts for all but direct light: paths from a light by one surface to
/// the lens. Next-event estimation finds direct light with little noise, however many light paths arrive on the
/// surface; the balance heuristic, which knows densities alone, would prefer the light paths. Where a guide makes light
/// paths sparser, that always counts. Weights only have to be the same function of the path for all techniques.
///
/// Curves are the reason for another exception. Light paths and eye paths see a flat curve from different sides, as
/// ribbons with different normals, so that weights there do not quite sum to 1. Dense light paths would make much of
/// that: indirect light was up to 27 % too bright. With curves in the scene, all paths have the weights of direct
/// light.
class EmissionDensities {
 public:
  /// `guide` of the light paths, null if they have none; must outlive this.
  explicit EmissionDensities(const Scene& scene, const EmissionGuide* guide = nullptr);

  /// Probability with which a light path begins on each light, as in PhotonAllocation.
  const std::vector<float>& of_lights() const { return of_lights_; }
  /// Factor that makes `pdf_emission` the density of light paths. `origin`: where the ray starts; of far lights any
  /// point of it.
  float factor(std::uint32_t light, const EmitterHit& origin, const Direction& direction, bool is_direct) const {
    const float p = of_lights_[light];
    if (guide_ == nullptr) return p;
    const float guided = guided_density(*guide_, scene_.lights()[light], light, origin, direction);
    return p * (is_direct || scene_.statistics().curves > 0 ? std::min(1.0f, guided) : guided);
  }

 private:
  Scene scene_;
  const EmissionGuide* guide_;
  std::vector<float> of_lights_;
};

}  // namespace lanthorn
