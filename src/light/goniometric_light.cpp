// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/goniometric_light.h"

#include "light/point_source.h"

namespace lanthorn {

std::optional<LightSample> GoniometricLight::sample_direct(const Point& from, const Vec2& /*one point*/,
                                                           const Wavelengths& w) const {
  std::optional<LightSample> sample = see_point_source(position, from);
  if (!sample) return sample;
  sample->radiance *= intensity.evaluate(w) * image->colour(map.light_from_world(-sample->wi).direction).g;
  if (sample->radiance.is_black()) sample.reset();
  return sample;
}

std::optional<EmissionSample> GoniometricLight::sample_emission(const Vec2& /*one point*/, const Vec2& u_direction,
                                                                const Wavelengths& w) const {
  std::optional<EmissionSample> result;
  const std::optional<SphericalImage::Sample> s = image->sample(u_direction);
  if (!s) return result;
  const DirectionMap::Mapped away = map.world_from_light(s->direction);
  EmissionSample& sample = result.emplace();
  sample.origin = position;
  sample.direction = away.direction;
  sample.pdf_direction = s->pdf * away.compression;
  sample.flux = intensity.evaluate(w) * (s->colour.g / sample.pdf_direction);
  return result;
}

EmissionPdf GoniometricLight::pdf_emission(const EmitterHit& /*one point*/, const Direction& direction) const {
  const DirectionMap::Mapped local = map.light_from_world(direction);
  return {1, image->pdf(local.direction) * local.compression};
}

EmissionNumbers GoniometricLight::invert_emission(const EmitterHit& /*one point*/, const Direction& direction) const {
  return {.direction = image->invert(map.light_from_world(direction).direction)};
}

// Exact for transforms that preserve angles; for other transforms the distribution of photons among lights is slightly
// off.
float GoniometricLight::power() const { return luminance(intensity.rgb) * image->mean_luminance * 4 * pi; }

float GoniometricLight::largest_radiance(float far2) const {
  return largest_value(intensity) * largest_value(image->texels) / (pi * far2);
}

EmissionBounds GoniometricLight::bounds() const {
  return {{position, position}, {{0, 0, 1}, -1}, 0, luminance(intensity.rgb) * image->mean_luminance, false};
}

}  // namespace lanthorn
