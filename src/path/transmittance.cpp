// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/transmittance.h"

#include <cmath>

namespace lanthorn {

namespace {

// Along a ray that may cross the borders of media.
Passage pass_media(const Scene& scene, Ray ray, MediumId medium, const Wavelengths& w, HashRng rng, RayCounts& counts) {
  Spectrum result(1);
  for (;;) {
    ++counts.shadow;
    const std::optional<SurfacePoint> at = scene.intersect(ray, w);
    if (at && !at->is_interface) return {};
    const float length = at ? std::sqrt(distance_squared(at->position, ray.origin)) : ray.t_max;
    if (medium != MediumId::vacuum)
      result *= transmittance(scene.medium(medium), {ray.origin, ray.direction, length}, w, rng);
    if (!at || result.is_black()) return {result, medium};
    medium = medium_towards(*at, ray.direction, medium);
    const float rest = ray.t_max - length;
    ray = spawn_ray(*at, ray.direction);
    ray.t_max = rest;
    if (!(rest > 0)) return {result, medium};
  }
}

Passage pass(const Scene& scene, const Ray& ray, MediumId medium, const Wavelengths& w, HashRng rng,
             RayCounts& counts) {
  if (scene.has_media()) return pass_media(scene, ray, medium, w, rng, counts);
  ++counts.shadow;
  return {scene.visible(ray) ? Spectrum(1) : Spectrum(), medium};
}

}  // namespace

Spectrum transmittance(const Scene& scene, const Ray& ray, MediumId medium, const Wavelengths& w, HashRng rng,
                       RayCounts& counts) {
  return pass(scene, ray, medium, w, rng, counts).transmittance;
}

Passage passage_from_infinity(const Scene& scene, const EmissionSample& emission, MediumId medium, float time,
                              const Wavelengths& w, HashRng rng, RayCounts& counts) {
  const BoundingSphere sphere = scene.bounding_sphere();
  const float far = 2 * sphere.radius + std::sqrt(distance_squared(sphere.centre, emission.origin));
  return pass(scene, {emission.origin - far * emission.direction, emission.direction, far, time}, medium, w, rng,
              counts);
}

}  // namespace lanthorn
