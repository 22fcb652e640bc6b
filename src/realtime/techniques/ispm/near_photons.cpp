// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/ispm/near_photons.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace lanthorn {

NearPhotons::NearPhotons(SharedPhotons photons, const PhotonVolume& volume)
    : photons_(std::move(photons)), volume_(volume), reach_(std::hypot(volume.radius, volume.half_height)) {
  std::vector<Point> points;
  points.reserve(photons_->photons.size());
  for (const GpuPhoton& photon : photons_->photons) points.push_back(photon.position);
  index_ = HashGrid::build(points, reach_);
}

void NearPhotons::gather(const SurfaceVertex& vertex, const LobeSplit& split, int max_depth,
                         LightLayers& layers) const {
  const GatherVertex met(vertex);
  Spectrum indirect, caustic;
  index_.index.for_each_near(vertex.at.position, reach_, [&](std::uint32_t slot, float) {
    const std::uint32_t i = index_.order[slot];
    if (!met.admits({.eye_scatterings = max_depth - static_cast<int>(photons_->depths[i])})) return;
    (i < photons_->indirect ? indirect : caustic) += light_of(photons_->photons[i], met, split);
  });
  const bool is_dispersed = met.is_dispersed(false);  // photons have their colour already
  layers.add(PathClass::indirect, vertex.state.beta * indirect, is_dispersed);
  layers.add(vertex.state.non_delta == 0 ? PathClass::caustic : PathClass::indirect, vertex.state.beta * caustic,
             is_dispersed);
}

Spectrum NearPhotons::light_of(const GpuPhoton& photon, const GatherVertex& met, const LobeSplit& split) const {
  const Vec3 offset = met.vertex().at.position - photon.position;
  const float height = dot(offset, photon.surface_normal()), r2 = volume_.radius * volume_.radius;
  const float flat2 = length_squared(offset) - height * height;
  if (flat2 >= r2 || std::fabs(height) > volume_.half_height) return {};
  const std::optional<PhotonHit> hit = met.scatter(photon.incident());
  if (!hit) return {};
  const Spectrum power(photon.power.x, photon.power.y, photon.power.z, 0);
  return hit->f * power * (split.wide(hit->pdf) * hit->ratio * 2 * inv_pi / r2 * (1 - flat2 / r2));
}

}  // namespace lanthorn
