// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Profiles: how the light of a point or of a far light depends on its direction. A light is a place (`PointLight`,
// `FarLight`) with a profile; to add one, write the profile here, or in a file if it has data of its own, and
// name the light in light.h. Also maps of directions.
#pragma once

#include <cmath>
#include <concepts>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <optional>

#include "lanthorn/transform.h"
#include "light/brightness.h"
#include "light/sample.h"
#include "math/frame.h"
#include "math/sampling.h"
#include "math/vec.h"
#include "spectrum/curve.h"
#include "spectrum/spectrum.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// A direction drawn from a profile.
struct ProfileSample {
  Direction direction{0, 0, 1};
  Spectrum value;  ///< of the profile in that direction
  float pdf = 1;   ///< per solid angle
};

/// A function of direction. At a point, its values are intensities (W/sr) away from the light; of a far light, radiance
/// from the direction towards it.
template <class P>
concept Profile = requires(const P p, const Direction d, const Vec2 u, const Wavelengths w) {
  { p.value(d, w) } -> std::same_as<Spectrum>;
  /// Nullopt if the profile is black.
  { p.sample(u, w) } -> std::same_as<std::optional<ProfileSample>>;
  { p.pdf(d) } -> std::same_as<float>;
  /// Inverse of `sample`: the numbers in [0,1)² that give this direction. Nullopt if there are none.
  { p.invert(d) } -> std::same_as<std::optional<Vec2>>;
  /// Integral of the luminance over all directions.
  { p.integral() } -> std::same_as<float>;
  /// Largest value, over the visible range or over the channels of RGB mode.
  { p.largest() } -> std::same_as<float>;
};

/// Bounds of the directions in which a point emits.
struct ProfileBounds {
  NormalCone cone{};       ///< about the emission's axis
  float cos_emission = 0;  ///< cosine of the largest angle to a direction of the cone at which it emits
  float intensity = 0;     ///< W/sr within the cone, as luminance, approximately
};

/// Maps directions from a light's own space to the world: any non-singular linear map followed by normalisation, as in
/// pbrt-v4. Scale has no effect, so the map is stored with determinant 1 or -1.
struct DirectionMap {
  struct Mapped {
    Direction direction{0, 0, 1};
    /// Solid angle in the light's space per solid angle in the world. A density in the light's space times this is the
    /// density in the world.
    float compression = 1;
  };

  glm::mat3 to_world{1.0f};
  glm::mat3 to_light{1.0f};

  DirectionMap() = default;
  explicit DirectionMap(const Transform& light_to_world);

  Mapped world_from_light(const Direction& local) const;
  Mapped light_from_world(const Direction& world) const;
};

/// The same in all directions.
struct EvenProfile {
  static constexpr const char *of_point = "point", *of_far = "infinite (constant)";

  SpectrumCurve curve;  ///< scale included

  Spectrum value(const Direction& /*all alike*/, const Wavelengths& w) const { return curve.evaluate(w); }
  std::optional<ProfileSample> sample(const Vec2& u, const Wavelengths& w) const {
    return ProfileSample{sample_uniform_sphere(u), curve.evaluate(w), pdf_uniform_sphere};
  }
  float pdf(const Direction& /*all alike*/) const { return pdf_uniform_sphere; }
  std::optional<Vec2> invert(const Direction& direction) const { return invert_uniform_sphere(direction); }
  float integral() const { return luminance(curve.rgb) * 4 * pi; }
  float largest() const { return largest_value(curve); }
  ProfileBounds bounds() const { return {{{0, 0, 1}, -1}, 0, luminance(curve.rgb)}; }
};

/// A disk in the sky: the same radiance from all directions in a cone.
class ConeProfile {
 public:
  static constexpr const char* of_far = "sun";

  ConeProfile() = default;
  /// `axis`: towards the light's centre. `half_angle`: of the cone, radians, in (0, π/2). `irradiance`: W/m² on a plane
  /// that faces the light: π sin² of the half angle times the radiance.
  ConeProfile(const Direction& axis, double half_angle, const SpectrumCurve& irradiance)
      : axis_(axis),
        one_minus_cos_(static_cast<float>(2 * sqr(std::sin(half_angle / 2)))),
        radiance_(irradiance.scaled(static_cast<float>(1 / (std::numbers::pi * sqr(std::sin(half_angle)))))) {}

  /// Of an image with four texels across the cone.
  float texels_across_right_angle() const { return pi / (2 * std::asin(std::sqrt(one_minus_cos_ / 2))); }

  Spectrum value(const Direction& d, const Wavelengths& w) const {
    return contains(d) ? radiance_.evaluate(w) : Spectrum();
  }
  std::optional<ProfileSample> sample(const Vec2& u, const Wavelengths& w) const {
    return ProfileSample{Frame(axis_).to_world(sample_uniform_cone(u, one_minus_cos_)), radiance_.evaluate(w),
                         pdf_uniform_cone(one_minus_cos_)};
  }
  float pdf(const Direction& d) const { return contains(d) ? pdf_uniform_cone(one_minus_cos_) : 0.0f; }
  std::optional<Vec2> invert(const Direction& d) const {
    return invert_uniform_cone(Frame(axis_).to_local(d), one_minus_cos_);
  }
  float integral() const { return luminance(radiance_.rgb) * 2 * pi * one_minus_cos_; }
  float largest() const { return largest_value(radiance_); }

 private:
  // By the distance of unit vectors, |a - b|² = 2 (1 - cos).
  bool contains(const Direction& d) const { return length_squared(d - axis_) <= 2 * one_minus_cos_; }

  Direction axis_{0, 0, 1};
  float one_minus_cos_ = 1;  ///< of the half angle: the cosine of a narrow cone cancels
  SpectrumCurve radiance_;   ///< W/(m² sr)
};

}  // namespace lanthorn
