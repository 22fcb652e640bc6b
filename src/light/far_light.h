// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Lights infinitely far away. Their photons start on a covering disk: it has the radius of the scene's bounding sphere,
// faces the light and lies in front of the scene on that side.
#pragma once

#include <optional>

#include "light/brightness.h"
#include "light/profile.h"
#include "light/sample.h"
#include "math/frame.h"
#include "math/sampling.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Area of the disk, m².
inline float covering_disk_area(const BoundingSphere& scene) { return pi * scene.radius * scene.radius; }
/// A point of the disk that faces `towards`. Uniform; density 1 / area.
inline Point sample_covering_disk(const BoundingSphere& scene, const Direction& towards, const Vec2& u) {
  const Vec2 d = sample_concentric_disk(u);
  return scene.centre + scene.radius * Frame(towards).to_world({d.x, d.y, 1});
}
/// Inverse of `sample_covering_disk`, for any point of the line through the disk towards `towards`.
inline Vec2 invert_covering_disk(const BoundingSphere& scene, const Direction& towards, const Point& p) {
  const Vec3 local = Frame(towards).to_local(p - scene.centre) / scene.radius;
  return invert_concentric_disk({local.x, local.y});
}

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

/// Parallel light from infinitely far away.
struct DistantLight {
  static constexpr LightTraits traits{.name = "distant", .has_surface = false, .is_infinite = false, .is_far = true};

  Direction towards{0, 0, 1};  ///< from the scene to the light
  SpectrumCurve irradiance;    ///< W/m² on a plane that faces the light, scale included (pbrt's L)
  BoundingSphere scene;

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const;
  float largest_radiance(float far2) const;
};

}  // namespace lanthorn
