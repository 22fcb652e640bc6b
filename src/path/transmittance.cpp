// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/transmittance.h"

#include <cmath>

namespace lanthorn {

namespace {

// Passage along a ray that may cross interfaces between media.
Passage pass_media(const PathContext& path, Ray ray, MediumId medium, HashRng rng) {
  Spectrum result(1);
  for (;;) {
    ++path.counts.shadow;
    const std::optional<SurfacePoint> at = path.scene.intersect(ray, path.w);
    if (at && !at->is_interface) return {};
    const float length = at ? std::sqrt(distance_squared(at->position, ray.origin)) : ray.t_max;
    if (medium != MediumId::vacuum)
      result *= transmittance(path.scene.medium(medium), {ray.origin, ray.direction, length}, path.w, rng);
    if (!at || result.is_black()) return {result, medium};
    medium = medium_towards(*at, ray.direction, medium);
    const float rest = ray.t_max - length;
    ray = spawn_ray(*at, ray.direction);
    ray.t_max = rest;
    if (!(rest > 0)) return {result, medium};
  }
}

Passage pass(const PathContext& path, const Ray& ray, MediumId medium, HashRng rng) {
  if (path.scene.has_media()) return pass_media(path, ray, medium, rng);
  ++path.counts.shadow;
  return {path.scene.visible(ray) ? Spectrum(1) : Spectrum(), medium};
}

}  // namespace

Spectrum transmittance(const PathContext& path, const Ray& ray, MediumId medium, HashRng rng) {
  return pass(path, ray, medium, rng).transmittance;
}

Passage passage_from_infinity(const PathContext& path, const EmissionSample& emission, MediumId medium, float time,
                              HashRng rng) {
  const BoundingSphere sphere = path.scene.bounding_sphere();
  const float far = 2 * sphere.radius + std::sqrt(distance_squared(sphere.centre, emission.origin));
  return pass(path, {emission.origin - far * emission.direction, emission.direction, far, time}, medium, rng);
}

}  // namespace lanthorn
