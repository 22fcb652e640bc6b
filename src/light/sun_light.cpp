// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/sun_light.h"

#include <cmath>
#include <numbers>

#include "light/brightness.h"
#include "light/distant_light.h"
#include "math/frame.h"
#include "math/sampling.h"

namespace lanthorn {

// The irradiance of a plane that faces a cone of unit radiance is π sin² of the half angle.
SunLight::SunLight(const Direction& towards, double half_angle, const SpectrumCurve& irradiance,
                   const BoundingSphere& scene_bounds)
    : scene(scene_bounds),
      towards_(towards),
      one_minus_cos_(static_cast<float>(2 * sqr(std::sin(half_angle / 2)))),
      radiance_(irradiance.scaled(static_cast<float>(1 / (std::numbers::pi * sqr(std::sin(half_angle)))))) {}

float SunLight::solid_angle() const { return 2 * pi * one_minus_cos_; }

float SunLight::half_angle() const { return 2 * std::asin(std::sqrt(one_minus_cos_ / 2)); }

// By the distance of unit vectors, |a - b|² = 2 (1 - cos).
bool SunLight::contains(const Direction& direction) const {
  return length_squared(direction - towards_) <= 2 * one_minus_cos_;
}

std::optional<LightSample> SunLight::sample_direct(const Point& /*all alike*/, const Vec2& u,
                                                   const Wavelengths& w) const {
  std::optional<LightSample> result;
  LightSample& sample = result.emplace();
  sample.wi = Frame(towards_).to_world(sample_uniform_cone(u, one_minus_cos_));
  sample.radiance = radiance_.evaluate(w);
  sample.pdf = pdf_uniform_cone(one_minus_cos_);
  return result;
}

float SunLight::pdf_direct(const Point& /*all alike*/, const Direction& towards) const {
  return contains(towards) ? pdf_uniform_cone(one_minus_cos_) : 0.0f;
}

Spectrum SunLight::emitted(const Point& /*all alike*/, const Direction& towards, const Wavelengths& w) const {
  return contains(towards) ? radiance_.evaluate(w) : Spectrum();
}

std::optional<EmissionSample> SunLight::sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                        const Wavelengths& w) const {
  std::optional<EmissionSample> result;
  const Direction towards = Frame(towards_).to_world(sample_uniform_cone(u_direction, one_minus_cos_));
  const float disk_area = covering_disk_area(scene);
  EmissionSample& sample = result.emplace();
  sample.origin = sample_covering_disk(scene, towards, u_position);
  sample.direction = -towards;
  sample.flux = radiance_.evaluate(w) * (solid_angle() * disk_area);
  sample.pdf_position = 1 / disk_area;
  sample.pdf_direction = pdf_uniform_cone(one_minus_cos_);
  return result;
}

EmissionPdf SunLight::pdf_emission(const EmitterHit& /*all alike*/, const Direction& direction) const {
  return {1 / covering_disk_area(scene), contains(-direction) ? pdf_uniform_cone(one_minus_cos_) : 0.0f};
}

EmissionNumbers SunLight::invert_emission(const EmitterHit& origin, const Direction& direction) const {
  const Vec3 local = Frame(towards_).to_local(-direction);
  return {invert_covering_disk(scene, -direction, origin.position), invert_uniform_cone(local, one_minus_cos_)};
}

float SunLight::power() const { return luminance(radiance_.rgb) * solid_angle() * covering_disk_area(scene); }

float SunLight::largest_radiance(float /*has extent*/) const { return largest_value(radiance_); }

}  // namespace lanthorn
