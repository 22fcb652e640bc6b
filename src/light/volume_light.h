// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "light/brightness.h"
#include "light/sample.h"
#include "math/distribution.h"
#include "medium/block_grid.h"
#include "medium/medium.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Where a medium emits: the density of the points at which its light paths start, constant in each block of a box.
class EmissionTable {
 public:
  /// `emission`: the mean emission of each block, any unit. Blocks where it is small get a twentieth of the mean, so
  /// that light is found that the means have missed. Precondition: not all are 0.
  EmissionTable(BlockGrid emission, const MediumBox& place);

  struct Start {
    Point position{0};
    float density = 0;  ///< per m³
  };
  Start sample(const Vec2& u) const;
  /// Integrals of the density along the ray from its origin on: over t, the density of light paths per area across the
  /// ray, and over t² dt, that of directions to such points per solid angle.
  float per_area(const Point& origin, const Direction& direction) const;
  float per_solid_angle(const Point& origin, const Direction& direction) const;
  Bounds world_bounds() const { return to_medium_.inverted().bounds(density_.box()); }

 private:
  template <class Integral>
  float integrate(const Point& origin, const Direction& direction, Integral&& integral) const;

  Transform to_medium_;  // from the world
  BlockGrid density_;    // per m³ of the world
  PiecewiseConstant2d blocks_;
};

/// A medium with volumetric emission. Next-event estimation chooses a direction by choosing a point, and takes the
/// emission along the whole ray (Simon, Hanika, Zirr & Dachsbacher 2017): a light path is a ray to all weights,
/// wherever on it the light comes from. The light alone cannot know what is on the way, so its samples have radiance 1,
/// to be multiplied by the glow along the ray.
struct VolumeLight {
  static constexpr LightTraits traits{
      .name = "volume", .has_surface = false, .is_infinite = false, .is_far = false, .is_volume = true};

  const Medium* medium = nullptr;
  std::shared_ptr<const EmissionTable> table;
  float watts = 0;    ///< luminance
  float largest = 0;  ///< radiance that no ray through it exceeds by much

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  float pdf_direct(const Point& from, const Direction& towards) const { return table->per_solid_angle(from, towards); }
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  /// `position` is per area across the ray. `origin`: where the ray has left the medium, or beyond.
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const { return watts; }
  float largest_radiance(float /*seen as it is*/) const { return largest; }
  EmissionBounds bounds() const;
};

}  // namespace lanthorn
