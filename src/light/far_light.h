// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/covering_disk.h"
#include "light/profile.h"
#include "light/sample.h"

namespace lanthorn {

/// A light with extent, infinitely far away. `P` has a name, `of_far`.
template <Profile P>
struct FarLight {
  static constexpr LightTraits traits{.name = P::of_far, .has_surface = false, .is_infinite = true, .is_far = true};

  P profile;  ///< radiance, W/(m² sr), by the direction towards the light
  BoundingSphere scene{};
  bool visible_to_camera = true;

  std::optional<LightSample> sample_direct(const Point& /*all alike*/, const Vec2& u, const Wavelengths& w) const {
    std::optional<LightSample> result;
    const std::optional<ProfileSample> s = profile.sample(u, w);
    if (!s) return result;
    LightSample& sample = result.emplace();
    sample.wi = s->direction;
    sample.radiance = s->value;
    sample.pdf = s->pdf;
    return result;
  }
  float pdf_direct(const Point& /*all alike*/, const Direction& towards) const { return profile.pdf(towards); }
  Spectrum emitted(const Point& /*all alike*/, const Direction& towards, const Wavelengths& w) const {
    return profile.value(towards, w);
  }

  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const {
    std::optional<EmissionSample> result;
    const std::optional<ProfileSample> s = profile.sample(u_direction, w);
    if (!s) return result;
    const float disk_area = covering_disk_area(scene);
    EmissionSample& sample = result.emplace();
    sample.origin = sample_covering_disk(scene, s->direction, u_position);
    sample.direction = -s->direction;
    sample.flux = s->value * (disk_area / s->pdf);
    sample.pdf_position = 1 / disk_area;
    sample.pdf_direction = s->pdf;
    return result;
  }
  EmissionPdf pdf_emission(const EmitterHit& /*all alike*/, const Direction& direction) const {
    return {1 / covering_disk_area(scene), profile.pdf(-direction)};
  }
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const {
    return {invert_covering_disk(scene, -direction, origin.position), profile.invert(-direction)};
  }

  float power() const { return profile.integral() * covering_disk_area(scene); }
  float largest_radiance(float /*has extent*/) const { return profile.largest(); }
};

}  // namespace lanthorn
