// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// An infinite light visible only through a rectangle, and sampled there (Bitterli, Novák & Jarosz 2015, "Portal-Masked
// Environment Map Sampling").
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "light/brightness.h"
#include "light/far_light.h"
#include "light/image_profile.h"
#include "light/profile.h"
#include "light/sample.h"
#include "math/distribution.h"
#include "math/frame.h"
#include "math/windowed_distribution.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

using EvenSky = FarLight<EvenProfile>;
using ImageSky = FarLight<ImageProfile>;
/// The light source on the far side of a portal.
using Sky = std::variant<EvenSky, ImageSky>;

/// A rectangle through which a sky shines. The sky's light is tabulated over two angles of directions in the portal's
/// frame; in these angles every point sees the portal as an axis-aligned rectangle. Owned by the scene.
struct Portal {
  Point corner{0};
  Frame frame;                          ///< s and t along the sides from the corner, n towards the sky
  float width = 0, height = 0;          ///< metres
  WindowedPiecewiseConstant2d towards;  ///< luminance times solid angle
  PiecewiseConstant2d through;          ///< luminance times projected solid angle
  float irradiance = 0;                 ///< luminance through the portal's plane, W/m²

  Portal() = default;
  /// `corners`: in order around the rectangle, in world space. Light travels in the direction (p1 - p0) x (p3 - p0).
  Portal(const std::array<Point, 4>& corners, const Sky& sky);

  float area() const { return width * height; }
  /// True if the line through `p` along `direction` (towards the sky) crosses the portal.
  bool is_crossed(const Point& p, const Direction& direction) const;
  /// Where that line crosses the portal's plane: coordinates along the two sides from the corner, metres.
  Vec2 crossing(const Point& p, const Direction& direction) const;
  /// The portal as a window of the square of angles. Returns nullopt if `from` is not on the side away from the sky.
  std::optional<WindowedPiecewiseConstant2d::Window> window(const Point& from) const;
};

/// Light of a sky through a portal. Points on the sky's side of the portal receive no light, as in pbrt-v4.
struct PortalLight {
  static constexpr LightTraits traits{
      .name = "infinite (portal)", .has_surface = false, .is_infinite = true, .is_far = true};

  Sky sky;
  const Portal* portal = nullptr;

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  float pdf_direct(const Point& from, const Direction& towards) const;
  Spectrum emitted(const Point& from, const Direction& towards, const Wavelengths& w) const;
  /// The photon starts at the portal, on its way from infinity: see EmissionSample::from_infinity.
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  EmissionNumbers invert_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const;
  float largest_radiance(float far2) const;
};

}  // namespace lanthorn
