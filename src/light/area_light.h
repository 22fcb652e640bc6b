// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "light/emitter.h"
#include "light/sample.h"
#include "spectrum/curve.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// A surface that emits the same radiance in all directions of its side, or of both.
///
/// The oriented geometric normal, which every function here takes and returns, is the shape's natural normal (see
/// emitter.h), negated if `flip_normal`. To agree with pbrt-v4 a quadric sets `flip_normal` to reverse_orientation !=
/// (the transform mirrors); a triangle or patch, whose corners are already in world space, likewise, unless the mesh
/// has shading normals: then the side is theirs. The normal must be that of the surface points that rays find.
struct AreaLight {
  EmitterShape shape;
  SpectrumCurve radiance;  ///< W/(m² sr), scale included
  bool two_sided = false;
  bool flip_normal = false;

  std::optional<LightSample> sample_direct(const Point& from, const Vec2& u, const Wavelengths& w) const;
  float pdf_direct(const Point& from, const EmitterHit& hit) const;
  Spectrum emitted(const EmitterHit& hit, const Direction& direction, const Wavelengths& w) const;
  std::optional<EmissionSample> sample_emission(const Vec2& u_position, const Vec2& u_direction,
                                                const Wavelengths& w) const;
  EmissionPdf pdf_emission(const EmitterHit& origin, const Direction& direction) const;
  float power() const;
};

}  // namespace lanthorn
