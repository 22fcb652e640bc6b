// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/infinite_light.h"

#include "light/distant_light.h"
#include "math/sampling.h"

namespace lanthorn {

std::optional<LightSample> UniformInfiniteLight::sample_direct(const Point& /*all alike*/, const Vec2& u,
                                                               const Wavelengths& w) const {
  std::optional<LightSample> result;
  LightSample& sample = result.emplace();
  sample.wi = sample_uniform_sphere(u);
  sample.radiance = radiance.evaluate(w);
  sample.pdf = pdf_uniform_sphere;
  return result;
}

float UniformInfiniteLight::pdf_direct(const Point& /*all alike*/, const Direction& /*all alike*/) const {
  return pdf_uniform_sphere;
}

Spectrum UniformInfiniteLight::emitted(const Point& /*all alike*/, const Direction& /*all alike*/,
                                       const Wavelengths& w) const {
  return radiance.evaluate(w);
}

std::optional<EmissionSample> UniformInfiniteLight::sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                                    const Wavelengths& w) const {
  std::optional<EmissionSample> result;
  const Direction towards = sample_uniform_sphere(u_direction);
  const float disk_area = covering_disk_area(scene);
  EmissionSample& sample = result.emplace();
  sample.origin = sample_covering_disk(scene, towards, u_position);
  sample.direction = -towards;
  sample.flux = radiance.evaluate(w) * (4 * pi * disk_area);
  sample.pdf_position = 1 / disk_area;
  sample.pdf_direction = pdf_uniform_sphere;
  return result;
}

EmissionPdf UniformInfiniteLight::pdf_emission(const EmitterHit& /*all alike*/, const Direction& /*all alike*/) const {
  return {1 / covering_disk_area(scene), pdf_uniform_sphere};
}

EmissionNumbers UniformInfiniteLight::invert_emission(const EmitterHit& origin, const Direction& direction) const {
  return {invert_covering_disk(scene, -direction, origin.position), invert_uniform_sphere(-direction)};
}

float UniformInfiniteLight::power() const { return luminance(radiance.rgb) * 4 * pi * covering_disk_area(scene); }

float UniformInfiniteLight::largest_radiance(float /*has extent*/) const { return largest_value(radiance); }

std::optional<LightSample> ImageInfiniteLight::sample_direct(const Point& /*all alike*/, const Vec2& u,
                                                             const Wavelengths& w) const {
  std::optional<LightSample> result;
  const std::optional<SphericalImage::Sample> s = image->sample(u);
  if (!s) return result;
  const DirectionMap::Mapped towards = map.world_from_light(s->direction);
  LightSample& sample = result.emplace();
  sample.wi = towards.direction;
  sample.radiance = evaluate_illuminant(scale * s->colour, w);
  sample.pdf = s->pdf * towards.compression;
  return result;
}

float ImageInfiniteLight::pdf_direct(const Point& /*all alike*/, const Direction& towards) const {
  const DirectionMap::Mapped local = map.light_from_world(towards);
  return image->pdf(local.direction) * local.compression;
}

Spectrum ImageInfiniteLight::emitted(const Point& /*all alike*/, const Direction& towards, const Wavelengths& w) const {
  return evaluate_illuminant(scale * image->colour(map.light_from_world(towards).direction), w);
}

std::optional<EmissionSample> ImageInfiniteLight::sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                                  const Wavelengths& w) const {
  std::optional<EmissionSample> result;
  const std::optional<LightSample> s = sample_direct(scene.centre, u_direction, w);
  if (!s) return result;
  const float disk_area = covering_disk_area(scene);
  EmissionSample& sample = result.emplace();
  sample.origin = sample_covering_disk(scene, s->wi, u_position);
  sample.direction = -s->wi;
  sample.flux = s->radiance * (disk_area / s->pdf);
  sample.pdf_position = 1 / disk_area;
  sample.pdf_direction = s->pdf;
  return result;
}

EmissionPdf ImageInfiniteLight::pdf_emission(const EmitterHit& origin, const Direction& direction) const {
  return {1 / covering_disk_area(scene), pdf_direct(origin.position, -direction)};
}

EmissionNumbers ImageInfiniteLight::invert_emission(const EmitterHit& origin, const Direction& direction) const {
  return {invert_covering_disk(scene, -direction, origin.position),
          image->invert(map.light_from_world(-direction).direction)};
}

// Exact for transforms that preserve angles, as scenes use; for other transforms the distribution of photons among
// lights is slightly off.
float ImageInfiniteLight::power() const { return scale * image->mean_luminance * 4 * pi * covering_disk_area(scene); }

float ImageInfiniteLight::largest_radiance(float /*has extent*/) const { return scale * largest_value(image->texels); }

}  // namespace lanthorn
