// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Profiles given by images of all directions.
#pragma once

#include <optional>

#include "light/brightness.h"
#include "light/direction_map.h"
#include "light/profile.h"
#include "light/spherical_image.h"
#include "spectrum/curve.h"

namespace lanthorn {

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
