// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <optional>
#include <vector>

#include "light/sample.h"
#include "math/distribution.h"
#include "math/transform.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// The same radiance from all directions.
struct UniformInfiniteLight {
  SpectrumCurve radiance;  ///< W/(m² sr), scale included
  BoundingSphere scene;

  std::optional<LightSample> sample_direct(const Vec2& u, const Wavelengths& w) const;
  float pdf_direct() const;
  Spectrum emitted(const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission() const;
  float power() const;
};

/// A square image of the sphere of directions in the equal-area octahedral layout (math/octahedral.h; z is up), with
/// the distribution that draws its texels in proportion to their luminance. Owned by the scene; lights point to it.
struct EnvironmentImage {
  int resolution = 0;                ///< texels along each side
  std::vector<Rgb> texels;           ///< row by row, the first row is the image's top (v = 0)
  PiecewiseConstant2d distribution;  ///< over (u, v) in [0,1)²
  float mean_luminance = 0;          ///< over the sphere

  EnvironmentImage() = default;
  /// `rows.size()` must be resolution²; negative and non-finite texels count as black.
  EnvironmentImage(int resolution, std::vector<Rgb> rows);
};

/// Radiance from an image: RGB times the illuminant, the nearest texel's.
struct ImageInfiniteLight {
  const EnvironmentImage* image = nullptr;
  float scale = 1;
  glm::mat3 light_to_world{1.0f};
  glm::mat3 world_to_light{1.0f};
  BoundingSphere scene;

  ImageInfiniteLight() = default;
  /// Any non-singular transform: directions go by its linear part and are normalised, as in pbrt-v4.
  ImageInfiniteLight(const EnvironmentImage* image, float scale, const Transform& light_to_world,
                     const BoundingSphere& scene);

  std::optional<LightSample> sample_direct(const Vec2& u, const Wavelengths& w) const;
  float pdf_direct(const Direction& towards) const;
  Spectrum emitted(const Direction& towards, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const Direction& direction) const;
  float power() const;
};

}  // namespace lanthorn
