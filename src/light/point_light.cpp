// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/point_light.h"

#include "light/point_source.h"
#include "math/sampling.h"

namespace lanthorn {

std::optional<LightSample> PointLight::sample_direct(const Point& from, const Vec2& /*one point*/,
                                                     const Wavelengths& w) const {
  std::optional<LightSample> sample = see_point_source(position, from);
  if (sample) sample->radiance *= intensity.evaluate(w);
  return sample;
}

std::optional<EmissionSample> PointLight::sample_emission(const Vec2& /*one point*/, const Vec2& u_direction,
                                                          const Wavelengths& w) const {
  std::optional<EmissionSample> result;
  EmissionSample& sample = result.emplace();
  sample.origin = position;
  sample.direction = sample_uniform_sphere(u_direction);
  sample.flux = intensity.evaluate(w) * (4 * pi);
  sample.pdf_direction = pdf_uniform_sphere;
  return result;
}

EmissionPdf PointLight::pdf_emission(const EmitterHit& /*one*/, const Direction& /*all alike*/) const {
  return {1, pdf_uniform_sphere};
}

EmissionNumbers PointLight::invert_emission(const EmitterHit& /*one point*/, const Direction& direction) const {
  return {.direction = invert_uniform_sphere(direction)};
}

float PointLight::power() const { return luminance(intensity.rgb) * 4 * pi; }

float PointLight::largest_radiance(float far2) const { return largest_value(intensity) / (pi * far2); }

EmissionBounds PointLight::bounds() const {
  return {{position, position}, {{0, 0, 1}, -1}, 0, luminance(intensity.rgb), false};
}

}  // namespace lanthorn
