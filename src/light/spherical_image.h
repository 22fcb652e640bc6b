// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "light/light_texels.h"
#include "math/distribution.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Layout of an image over the sphere of directions, z up.
enum class SphereLayout : std::uint8_t {
  octahedral,      ///< square, equal-area octahedral (math/octahedral.h): pbrt-v4's
  equirectangular  ///< u = phi / 2 pi, v = theta / pi, the top row at z = 1: what pbrt's imgtool makeequiarea reads
};

/// A function of direction as an image, with a distribution that samples directions in proportion to its luminance. The
/// octahedral layout is looked up at the nearest texel, as in pbrt-v4; the equirectangular layout bilinearly. Owned by
/// the scene; lights point to it.
struct SphericalImage {
  struct Sample {
    Direction direction{0, 0, 1};
    Rgb colour;
    float pdf = 0;  ///< per solid angle
  };

  SphereLayout layout = SphereLayout::octahedral;
  int width = 0, height = 0;
  LightTexels texels;        ///< the first row is the image's top (v = 0)
  float mean_luminance = 0;  ///< over the sphere

  SphericalImage() = default;
  /// `rows.size()` must be width * height; width must equal height in the octahedral layout. Negative and non-finite
  /// values count as 0.
  SphericalImage(SphereLayout layout, int width, int height, LightTexels rows);

  Rgb colour(const Direction& d) const;
  /// Density of `sample`, per solid angle: positive wherever the colour is not black.
  float pdf(const Direction& d) const;
  /// Returns nullopt if the image is black.
  std::optional<Sample> sample(const Vec2& u) const;
  /// Inverse of `sample`: the u in [0,1)² that maps to this direction.
  Vec2 invert(const Direction& d) const;
  /// Direction of a texel's centre.
  Direction direction_of_texel(int x, int y) const;
  /// Solid angle of each texel of row y, sr.
  float solid_angle_of_texel(int y) const;

 private:
  Rgb bilinear(const Vec2& uv) const;
  Rgb wrapped_texel(int x, int y) const;
  float density_factor(const Direction& d) const;

  PiecewiseConstant2d distribution_;  // over (u, v) in [0,1)²
};

}  // namespace lanthorn
