// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>

#include "light/brightness.h"
#include "light/emitter.h"
#include "light/sample.h"
#include "light/spread.h"
#include "math/distribution.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Emission of a textured shape. The scene owns textures and parametrisations and provides them as functions. Both give
/// radiance in W/(m² sr), before `AreaLight::pattern_scale`.
struct EmissionPattern {
  /// Radiance at the point where a ray has met the surface.
  std::function<Spectrum(std::uint32_t primitive, const EmitterHit&, const Wavelengths&)> seen;
  /// Radiance at a sampled point of a primitive with its oriented normal, times the fraction of rays that alpha does
  /// not let through: rays that pass through the surface see no emission.
  std::function<Spectrum(std::uint32_t primitive, const Point&, const Normal&, const Wavelengths&)> drawn;
};

/// A surface that emits the same radiance in all directions of its side, or of both sides, times the factor of
/// `spread`.
///
/// The oriented geometric normal, which every function here takes and returns, is the shape's natural normal (see
/// emitter.h), negated if `flip_normal`: by ReverseOrientation for a quadric; also by a mirroring transform for a
/// triangle or patch, whose corners are already in world space, unless the mesh has shading normals, which then
/// determine the side. The normal must equal the normal of the surface points that rays find.
struct AreaLight {
  static constexpr LightTraits traits{.name = "area", .has_surface = true, .is_infinite = false, .is_far = false};

  EmitterShape shape;
  /// W/(m² sr), scale included. If there is a pattern: the mean colour over the surface, with a flat spectrum, for
  /// choosing among lights.
  SpectrumCurve radiance;
  bool two_sided = false;
  bool flip_normal = false;
  bool invisible = false;  ///< no ray can hit the surface
  Spread spread{};
  const EmissionPattern* pattern = nullptr;  ///< null: the radiance is uniform
  float pattern_scale = 1;
  std::uint32_t primitive = 0;  ///< primitive of the pattern's shape
  /// Bound of the distance between sampled points and the surface that rays meet: metres, and metres per metre of a
  /// ray's length. The scene sets both, because they depend on how it maps the surface.
  float position_error = 0, tracing_error = 0;
  /// Density proportional to the pattern's brightness over the square that `sample_area` draws from, for shapes that
  /// support `invert_sample_area`. Must be positive wherever the pattern is. Null: points are drawn uniformly.
  const PiecewiseConstant2d* brightness = nullptr;

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  float pdf_direct(const Point& from, const EmitterHit& hit) const;
  Spectrum emitted(const EmitterHit& hit, const Direction& direction, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const;
  float largest_radiance(float far2) const;
  EmissionBounds bounds() const;

 private:
  /// Density of photon origins times the area: 1 if they are drawn uniformly.
  float density_at(const Point& point) const;
  EmitterPoint sample_position(const Vec2& u) const;
  /// Factor of the radiance in a direction, 0 on a dark side.
  float factor_towards(const Normal& normal, const Direction& direction) const {
    const float cos = dot(normal, direction);
    return cos > 0 || two_sided ? spread.factor(std::fabs(cos)) : 0.0f;
  }
  /// The shape if it is a sphere whose photons have their direction drawn before their position, else null.
  const SphereEmitter* leaves_by_direction() const;
  std::optional<EmitterDirection> draw_towards(const Point& from, const Vec2& u) const;
  float pdf_of_drawn(const Point& from, const Point& hit, const Normal& normal) const;
  /// Fills the sample of emission from a point, whose `density_at` is `density`.
  void emit(const EmitterPoint& at, float density, const Direction& direction, const Wavelengths& w,
            EmissionSample& sample) const;
  Spectrum radiance_at(const Point& drawn, const Normal& normal, const Wavelengths& w) const;
};

}  // namespace lanthorn
