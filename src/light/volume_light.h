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

/// Density of the points where a medium's light paths start, constant in each block of a box.
class EmissionTable {
 public:
  /// `emission`: the mean emission of each block, in any unit. Blocks below a twentieth of the overall mean are raised
  /// to it, so that emission that the block means missed is still sampled. Precondition: not all are 0.
  EmissionTable(BlockGrid emission, const MediumBox& place);

  struct Start {
    Point position{0};
    float density = 0;  ///< per m³
  };
  Start sample(const Vec2& u) const;
  /// Integrals of the density along a ray from its origin. `per_area`: over dt, the density of light paths per area
  /// across the ray. `per_solid_angle`: over t² dt, the density of directions from the origin to such points.
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

/// A medium with volumetric emission. Next-event estimation chooses a direction by choosing a point in the medium, and
/// takes the emission along the whole ray (Simon, Hanika, Zirr & Dachsbacher 2017). MIS weights therefore treat the
/// start of a light path as a ray, wherever along it the light is emitted. The light does not know what lies along the
/// ray, so its samples have radiance 1, which the caller multiplies by the emission along the ray.
struct VolumeLight {
  static constexpr LightTraits traits{
      .name = "volume", .has_surface = false, .is_infinite = false, .is_far = false, .is_volume = true};

  const Medium* medium = nullptr;
  std::shared_ptr<const EmissionTable> table;
  float watts = 0;    ///< emitted power, W, as luminance
  float largest = 0;  ///< approximate bound of the radiance along any ray through the medium

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  float pdf_direct(const Point& from, const Direction& towards) const { return table->per_solid_angle(from, towards); }
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  /// `position` is per area across the ray. `origin`: the point where the ray leaves the medium, or any point beyond.
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const { return watts; }
  float largest_radiance(float /*seen as it is*/) const { return largest; }
  EmissionBounds bounds() const;
};

}  // namespace lanthorn
