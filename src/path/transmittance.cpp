// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/transmittance.h"

#include <cmath>

namespace lanthorn {

namespace {

// Passage along a ray that may cross interfaces between media.
Passage pass_media(const PathContext& path, Ray ray, MediumId medium, HashRng rng) {
  Passage result{Spectrum(1), medium};
  for (;;) {
    ++path.counts.shadow;
    const std::optional<SurfacePoint> at = path.scene.intersect(ray, path.w);
    if (at && !at->is_interface) return {};
    const float length = at ? std::sqrt(distance_squared(at->position, ray.origin)) : ray.t_max;
    if (result.medium != MediumId::vacuum) {
      const Medium& here = path.scene.medium(result.medium);
      result.transmittance *= transmittance(here, {ray.origin, ray.direction, length}, path.w, rng);
      if (const float extinction = mean_extinction(here, path.w); extinction > 0)
        result.optical_depth += extinction * length;
    }
    if (!at || result.transmittance.is_black()) return result;
    result.medium = medium_towards(*at, ray.direction, result.medium);
    const float rest = ray.t_max - length;
    ray = spawn_ray(*at, ray.direction);
    ray.t_max = rest;
    if (!(rest > 0)) return result;
  }
}

}  // namespace

Passage passage(const PathContext& path, const Ray& ray, MediumId medium, HashRng rng) {
  if (path.scene.has_media()) return pass_media(path, ray, medium, rng);
  ++path.counts.shadow;
  return {path.scene.visible(ray) ? Spectrum(1) : Spectrum(), medium};
}

Passage passage_from_infinity(const PathContext& path, const EmissionSample& emission, MediumId medium, float time,
                              HashRng rng) {
  const BoundingSphere sphere = path.scene.bounding_sphere();
  const float far = 2 * sphere.radius + std::sqrt(distance_squared(sphere.centre, emission.origin));
  return passage(path, {emission.origin - far * emission.direction, emission.direction, far, time}, medium, rng);
}

}  // namespace lanthorn
