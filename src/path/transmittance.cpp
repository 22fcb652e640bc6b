// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/transmittance.h"

#include <cmath>

namespace lanthorn {

namespace {

// Along a ray that may cross the borders of media.
Spectrum transmittance_through_media(const Scene& scene, Ray ray, MediumId medium, const Wavelengths& w, HashRng rng,
                                     RayCounts& counts) {
  Spectrum result(1);
  for (;;) {
    ++counts.shadow;
    const std::optional<SurfacePoint> at = scene.intersect(ray, w);
    if (at && !at->is_interface) return {};
    const float length = at ? std::sqrt(distance_squared(at->position, ray.origin)) : ray.t_max;
    if (medium != MediumId::vacuum)
      result *= transmittance(scene.medium(medium), {ray.origin, ray.direction, length}, w, rng);
    if (!at || result.is_black()) return result;
    medium = medium_towards(*at, ray.direction, medium);
    const float rest = ray.t_max - length;
    ray = spawn_ray(*at, ray.direction);
    ray.t_max = rest;
    if (!(rest > 0)) return result;
  }
}

}  // namespace

Spectrum transmittance(const Scene& scene, const Ray& ray, MediumId medium, const Wavelengths& w, HashRng rng,
                       RayCounts& counts) {
  if (scene.has_media()) return transmittance_through_media(scene, ray, medium, w, rng, counts);
  ++counts.shadow;
  return scene.visible(ray) ? Spectrum(1) : Spectrum();
}

}  // namespace lanthorn
