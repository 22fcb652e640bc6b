// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/brightness.h"
#include "light/direction_map.h"
#include "light/emitter_sample.h"
#include "light/light_texels.h"
#include "light/sample.h"
#include "math/distribution.h"
#include "spectrum/wavelengths.h"

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

/// A point that projects an image: its intensity in W/sr is RGB times the illuminant, as pbrt-v4 defines it.
struct ProjectionLight {
  static constexpr LightTraits traits{
      .name = "projection", .has_surface = false, .is_infinite = false, .is_far = false};

  Point position{0};
  float scale = 1;
  const ProjectionImage* image = nullptr;
  DirectionMap map;

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const;
  float largest_radiance(float far2) const;
  EmissionBounds bounds() const;
  /// A cone around all directions of emission.
  NormalCone cone() const;
};

}  // namespace lanthorn
