// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Profiles: how the light of a point or of a far light depends on its direction. A light is a place (`PointLight`,
// `FarLight`) with a profile; to add one, write the profile's file and name the light in light.h.
#pragma once

#include <concepts>
#include <optional>

#include "light/emitter_sample.h"
#include "math/vec.h"
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

}  // namespace lanthorn
