// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>

#include "light/brightness.h"
#include "light/emitter.h"
#include "light/sample.h"
#include "math/distribution.h"
#include "math/sampling.h"
#include "math/vec.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// The angular profile of a surface behind a grid of deep slats (a soft box), as Cycles models it.
///
/// The factor of a diffuse emitter's radiance at the angle θ to the normal: the slats leave 1 - tan θ / tan h of it, up
/// to the half angle h. The factor's mean over the emitter's directions is 1,
///   ∫ (1 - tan θ / tan h) 2 cos θ sin θ dθ = 1 - h / tan h  over [0, h],
/// so that the power is the same as for the diffuse emitter.
class Spread {
 public:
  /// A diffuse emitter.
  Spread() = default;
  /// `half_angle`: h, radians, in (0, π/2].
  explicit Spread(double half_angle) {
    if (half_angle >= 0.5 * std::numbers::pi) return;
    tan_ = static_cast<float>(std::tan(half_angle));
    peak_ = static_cast<float>(1 / (1 - half_angle / std::tan(half_angle)));
  }

  bool is_diffuse() const { return tan_ == infinity; }
  /// The factor along the normal, which is the largest.
  float peak() const { return peak_; }
  float sin() const { return is_diffuse() ? 1.0f : tan_ / std::sqrt(1 + tan_ * tan_); }
  float cos() const { return is_diffuse() ? 0.0f : 1 / std::sqrt(1 + tan_ * tan_); }

  /// `cos`: of the angle to the normal, in [0,1].
  float factor(float cos) const {
    if (is_diffuse()) return 1;
    const float left = cos * tan_ - safe_sqrt(1 - cos * cos);
    return left > 0 ? peak_ * left / (cos * tan_) : 0.0f;
  }
  /// Density per solid angle of the directions that `sample` draws.
  float pdf(float cos) const {
    if (is_diffuse()) return pdf_cosine_hemisphere(cos);
    const float sine = sin();
    return cos > this->cos() ? pdf_cosine_hemisphere(cos) / (sine * sine) : 0.0f;
  }
  /// Draws a direction inside the cone around z, in proportion to its cosine.
  Direction sample(const Vec2& u) const {
    if (is_diffuse()) return sample_cosine_hemisphere(u);
    const Vec2 d = sin() * sample_concentric_disk(u);
    return {d.x, d.y, safe_sqrt(1 - dot(d, d))};
  }
  /// The numbers from which `sample` draws a direction.
  Vec2 invert(const Direction& direction) const {
    return invert_concentric_disk(Vec2(direction.x, direction.y) / sin());
  }

 private:
  float tan_ = infinity, peak_ = 1;  // of the half angle; along the normal
};

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
