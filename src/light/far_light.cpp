// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/far_light.h"

namespace lanthorn {

std::optional<LightSample> DistantLight::sample_direct(const Point& /*all alike*/, const Vec2& /*one direction*/,
                                                       const Wavelengths& w) const {
  std::optional<LightSample> result;
  LightSample& sample = result.emplace();
  sample.wi = towards;
  sample.radiance = irradiance.evaluate(w);
  sample.pdf = 1;
  sample.delta = true;
  return result;
}

std::optional<EmissionSample> DistantLight::sample_emission(const Vec2& u_position, const Vec2& /*one direction*/,
                                                            const Wavelengths& w) const {
  std::optional<EmissionSample> result;
  const float disk_area = covering_disk_area(scene);
  EmissionSample& sample = result.emplace();
  sample.origin = sample_covering_disk(scene, towards, u_position);
  sample.direction = -towards;
  sample.flux = irradiance.evaluate(w) * disk_area;
  sample.pdf_position = 1 / disk_area;
  return result;
}

EmissionPdf DistantLight::pdf_emission(const EmitterHit& /*all alike*/, const Direction& /*one*/) const {
  return {1 / covering_disk_area(scene), 1};
}

EmissionNumbers DistantLight::invert_emission(const EmitterHit& origin, const Direction& /*one*/) const {
  return {.position = invert_covering_disk(scene, towards, origin.position)};
}

float DistantLight::power() const { return luminance(irradiance.rgb) * covering_disk_area(scene); }

float DistantLight::largest_radiance(float /*as bright at any distance*/) const {
  return largest_value(irradiance) / pi;
}

}  // namespace lanthorn
