// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/light_texels.h"
#include "light/profile.h"
#include "math/distribution.h"

namespace lanthorn {

/// A projector's image: an image on the plane z = 1 of the light's space, x to the right and y up, with a distribution
/// that samples directions in proportion to the projected luminance. Owned by the scene.
struct ProjectionImage {
  struct Sample {
    Direction direction{0, 0, 1};
    Rgb colour;
    float pdf = 0;  ///< per solid angle
  };

  int width = 0, height = 0;
  LightTexels texels;    ///< the first row is the top
  Vec2 half_size{1, 1};  ///< half size of the image on the plane
  float integral = 0;    ///< integral of the luminance over solid angle, sr

  ProjectionImage() = default;
  /// `fov`: angle over the image's shorter side, radians, in (0, pi). `rows.size()` must be width * height. Negative
  /// and non-finite values count as 0.
  ProjectionImage(int width, int height, LightTexels rows, float fov);

  /// The nearest texel, as in pbrt-v4; black outside the image.
  Rgb colour(const Direction& d) const;
  float pdf(const Direction& d) const;
  /// Returns nullopt if the image is black.
  std::optional<Sample> sample(const Vec2& u) const;
  /// Inverse of `sample`: the u in [0,1)² that maps to this direction. Nullopt beside the image.
  std::optional<Vec2> invert(const Direction& d) const;
  float solid_angle() const;

 private:
  std::optional<Vec2> image_point(const Direction& d) const;
  float area() const { return 4 * half_size.x * half_size.y; }

  PiecewiseConstant2d distribution_;  // over (u, v) in [0,1)²
};

/// The intensities of a projector: RGB times the illuminant in W/sr, as pbrt-v4 defines it.
struct ProjectionProfile {
  static constexpr const char* of_point = "projection";

  float scale = 1;
  const ProjectionImage* image = nullptr;
  DirectionMap map;

  Spectrum value(const Direction& d, const Wavelengths& w) const;
  std::optional<ProfileSample> sample(const Vec2& u, const Wavelengths& w) const;
  float pdf(const Direction& d) const;
  std::optional<Vec2> invert(const Direction& d) const;
  /// Exact for transforms that preserve angles; for other transforms the distribution of photons among lights is
  /// slightly off.
  float integral() const { return scale * image->integral; }
  float largest() const;
  ProfileBounds bounds() const { return {cone(), 1, integral() / image->solid_angle()}; }
  /// A cone around all directions of emission.
  NormalCone cone() const;
};

}  // namespace lanthorn
