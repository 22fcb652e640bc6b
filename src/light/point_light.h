// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "light/brightness.h"
#include "light/profile.h"
#include "light/sample.h"

namespace lanthorn {

/// A light without extent. `P` has a name, `of_point`, and `bounds()` (`ProfileBounds`).
template <Profile P>
struct PointLight {
  static constexpr LightTraits traits{.name = P::of_point, .has_surface = false, .is_infinite = false, .is_far = false};

  Point position{0};
  P profile;  ///< intensity by the direction away from the light

  /// Nullopt also if `from` coincides with the light or is too near for single precision.
  std::optional<LightSample> sample_direct(const Point& from, const Vec2& /*one point*/, const Wavelengths& w) const {
    std::optional<LightSample> result;
    const Vec3 d = position - from;
    const float distance2 = length_squared(d), share = 1 / distance2;
    if (!(share < infinity)) return result;
    LightSample& sample = result.emplace();
    sample.distance = std::sqrt(distance2);
    sample.wi = d / sample.distance;
    sample.position = position;
    sample.radiance = profile.value(-sample.wi, w) * share;
    sample.pdf = 1;
    sample.delta = true;
    if (sample.radiance.is_black()) result.reset();
    return result;
  }

  std::optional<EmissionSample> sample_emission(const Vec2& /*one point*/, const Vec2& u_direction,
                                                const Wavelengths& w) const {
    std::optional<EmissionSample> result;
    const std::optional<ProfileSample> s = profile.sample(u_direction, w);
    if (!s || !(s->pdf > 0)) return result;
    EmissionSample& sample = result.emplace();
    sample.origin = position;
    sample.direction = s->direction;
    sample.flux = s->value / s->pdf;
    sample.pdf_direction = s->pdf;
    return result;
  }
  EmissionPdf pdf_emission(const EmitterHit& /*one point*/, const Direction& direction) const {
    return {1, profile.pdf(direction)};
  }
  EmissionNumbers invert_emission(const EmitterHit& /*one point*/, const Direction& direction) const {
    return {.direction = profile.invert(direction)};
  }

  float power() const { return profile.integral(); }
  float largest_radiance(float far2) const { return profile.largest() / (pi * far2); }
  EmissionBounds bounds() const {
    const ProfileBounds b = profile.bounds();
    return {{position, position}, b.cone, b.cos_emission, b.intensity, false};
  }
};

}  // namespace lanthorn
