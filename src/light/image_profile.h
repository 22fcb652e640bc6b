// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Profiles given by images of all directions.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "light/brightness.h"
#include "light/light_texels.h"
#include "light/profile.h"
#include "math/distribution.h"
#include "math/vec.h"
#include "spectrum/curve.h"
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

/// An image and the space of its directions.
struct PlacedImage {
  const SphericalImage* image = nullptr;
  DirectionMap map{};

  Rgb colour(const Direction& d) const { return image->colour(map.light_from_world(d).direction); }
  float pdf(const Direction& d) const {
    const DirectionMap::Mapped local = map.light_from_world(d);
    return image->pdf(local.direction) * local.compression;
  }
  /// In the world. Nullopt if the image is black.
  std::optional<SphericalImage::Sample> sample(const Vec2& u) const {
    std::optional<SphericalImage::Sample> s = image->sample(u);
    if (!s) return s;
    const DirectionMap::Mapped world = map.world_from_light(s->direction);
    s->direction = world.direction;
    s->pdf *= world.compression;
    return s;
  }
  Vec2 invert(const Direction& d) const { return image->invert(map.light_from_world(d).direction); }
  /// Integral of the luminance over all directions. Exact for transforms that preserve angles; for other transforms the
  /// distribution of photons among lights is slightly off.
  float integral() const { return image->mean_luminance * 4 * pi; }
};

/// Radiance as an image: RGB times the illuminant.
struct ImageProfile : PlacedImage {
  static constexpr const char* of_far = "infinite (image)";

  float scale = 1;

  Spectrum value(const Direction& d, const Wavelengths& w) const { return evaluate_illuminant(scale * colour(d), w); }
  std::optional<ProfileSample> sample(const Vec2& u, const Wavelengths& w) const {
    const auto s = PlacedImage::sample(u);
    if (!s) return {};
    return ProfileSample{s->direction, evaluate_illuminant(scale * s->colour, w), s->pdf};
  }
  std::optional<Vec2> invert(const Direction& d) const { return PlacedImage::invert(d); }
  float integral() const { return scale * PlacedImage::integral(); }
  float largest() const { return scale * largest_value(image->texels); }
  float texels_across_right_angle() const {
    const auto width = static_cast<float>(image->width);
    // The octahedral square has the area of the sphere, which is about that of six squares that each span a right
    // angle.
    return image->layout == SphereLayout::equirectangular ? width / 4 : width / std::sqrt(6.0f);
  }
};

/// Intensities of a luminaire: a spectrum times a grey image.
struct GoniometricProfile : PlacedImage {
  static constexpr const char* of_point = "goniometric";

  SpectrumCurve intensity{};  ///< W/sr where the image is 1, scale included

  Spectrum value(const Direction& d, const Wavelengths& w) const { return intensity.evaluate(w) * colour(d).g; }
  std::optional<ProfileSample> sample(const Vec2& u, const Wavelengths& w) const {
    const auto s = PlacedImage::sample(u);
    if (!s) return {};
    return ProfileSample{s->direction, intensity.evaluate(w) * s->colour.g, s->pdf};
  }
  std::optional<Vec2> invert(const Direction& d) const { return PlacedImage::invert(d); }
  float integral() const { return luminance(intensity.rgb) * PlacedImage::integral(); }
  float largest() const { return largest_value(intensity) * largest_value(image->texels); }
  ProfileBounds bounds() const { return {{{0, 0, 1}, -1}, 0, luminance(intensity.rgb) * image->mean_luminance}; }
};

}  // namespace lanthorn
