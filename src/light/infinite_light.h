// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/brightness.h"
#include "light/direction_map.h"
#include "light/sample.h"
#include "light/spherical_image.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// The same radiance from all directions.
struct UniformInfiniteLight {
  static constexpr LightTraits traits{
      .name = "infinite (constant)", .has_surface = false, .is_infinite = true, .is_far = true};

  SpectrumCurve radiance;  ///< W/(m² sr), scale included
  BoundingSphere scene;

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  float pdf_direct(const Point& from, const Direction& towards) const;
  Spectrum emitted(const Point& from, const Direction& towards, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const;
  float largest_radiance(float far2) const;
};

/// Radiance from an image: RGB times the illuminant.
struct ImageInfiniteLight {
  static constexpr LightTraits traits{
      .name = "infinite (image)", .has_surface = false, .is_infinite = true, .is_far = true};

  const SphericalImage* image = nullptr;
  float scale = 1;
  DirectionMap map;
  BoundingSphere scene;

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  float pdf_direct(const Point& from, const Direction& towards) const;
  Spectrum emitted(const Point& from, const Direction& towards, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const;
  float largest_radiance(float far2) const;
};

}  // namespace lanthorn
