// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/transmittance.h"

#include <cmath>
#include <cstdint>
#include <optional>

#include "math/hash.h"

namespace lanthorn {

namespace {

enum class RayEnd : std::uint8_t { scene, lens };

// Follows a ray across interfaces between media, and calls `visit(medium, segment, is_blocked)` for each part of it,
// the last one up to a surface that blocks it, until that returns false. Returns the medium at its end, none if a
// surface is in the way or `visit` has stopped. Rays to the lens also cross shapes that are hidden from the camera.
template <RayEnd end = RayEnd::scene, class Visit>
std::optional<MediumId> cross_interfaces(const PathContext& path, Ray ray, MediumId medium, Visit&& visit) {
  for (;;) {
    ++path.counts.shadow;
    const std::optional<SurfacePoint> at = path.scene.intersect(ray, path.w);
    const float length = at ? std::sqrt(distance_squared(at->position, ray.origin)) : ray.t_max;
    const bool is_hidden = end == RayEnd::lens && at && at->is_hidden;
    const bool is_blocked = at && !at->is_interface && !is_hidden;
    if (!visit(medium, Segment{ray.origin, ray.direction, length}, is_blocked) || is_blocked) return {};
    if (!at) return medium;
    if (!is_hidden) medium = medium_towards(*at, ray.direction, medium);
    ray = continue_segment(*at, ray);
    if (!(ray.t_max > 0)) return medium;
  }
}

template <RayEnd end = RayEnd::scene>
Passage pass_media(const PathContext& path, const Ray& ray, MediumId medium, HashRng rng) {
  Passage result{Spectrum(1), medium};
  const auto attenuate = [&](MediumId here, const Segment& way) {
    if (here == MediumId::vacuum) return true;
    const Attenuation part = attenuation(path.scene.medium(here), way, path.w, rng);
    result.transmittance *= part.transmittance;
    result.optical_depth += part.optical_depth;
    return !result.transmittance.is_black();
  };
  if (end == RayEnd::scene && !path.scene.has_interfaces()) {
    // The whole way lies in one medium, and any surface on it blocks.
    ++path.counts.shadow;
    if (!path.scene.visible(ray) || !attenuate(medium, {ray.origin, ray.direction, ray.t_max})) return {};
    return result;
  }
  const std::optional<MediumId> last = cross_interfaces<end>(
      path, ray, medium,
      [&](MediumId here, const Segment& way, bool is_blocked) { return !is_blocked && attenuate(here, way); });
  if (!last) return {};
  result.medium = *last;
  return result;
}

}  // namespace

Passage passage(const PathContext& path, const Ray& ray, MediumId medium, std::uint32_t dimensions) {
  if (path.scene.has_media()) return pass_media(path, ray, medium, path.sampler.generator(dimensions));
  ++path.counts.shadow;
  return {path.scene.visible(ray) ? Spectrum(1) : Spectrum(), medium};
}

Passage passage_to_lens(const PathContext& path, const Ray& ray, MediumId medium, std::uint32_t dimensions) {
  if (!path.scene.has_hidden_shapes()) return passage(path, ray, medium, dimensions);
  return pass_media<RayEnd::lens>(path, ray, medium, path.sampler.generator(dimensions));
}

Spectrum volume_emission(const PathContext& path, const Ray& ray, MediumId medium, MediumId emissive,
                         std::uint32_t dimensions) {
  HashRng rng = path.sampler.generator(dimensions);
  Spectrum sum, transmitted(1);
  cross_interfaces(path, ray, medium, [&](MediumId here, const Segment& way, bool is_blocked) {
    if (here == emissive) {
      const VolumeEmission part = emission_along(path.scene.medium(here), way, path.w, rng);
      sum += transmitted * part.emitted;
      transmitted *= part.transmittance;
    } else if (here != MediumId::vacuum && !is_blocked) {
      transmitted *= transmittance(path.scene.medium(here), way, path.w, rng);
    }
    return !transmitted.is_black();
  });
  return sum;
}

Passage passage_from_infinity(const PathContext& path, const EmissionSample& emission, MediumId medium, float time,
                              std::uint32_t dimensions) {
  const BoundingSphere sphere = path.scene.bounding_sphere();
  const float far = 2 * sphere.radius + std::sqrt(distance_squared(sphere.centre, emission.origin));
  return passage(path, {emission.origin - far * emission.direction, emission.direction, far, time}, medium, dimensions);
}

}  // namespace lanthorn
