// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Irradiance at a point and how it changes nearby, from rays over the hemisphere (Ward & Heckbert 1992, "Irradiance
// Gradients").
#pragma once

#include <span>

#include "math/frame.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Change of a spectrum per unit of a vector.
struct SpectrumGradient {
  Spectrum x, y, z;

  Spectrum along(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
  void add(const Vec3& direction, const Spectrum& s) {
    x += s * direction.x;
    y += s * direction.y;
    z += s * direction.z;
  }
};

/// Irradiance, W/m², at a surface, to be used nearby.
struct IrradianceRecord {
  Point position{0};
  Normal normal{0, 0, 1};     ///< on the side that the light comes from
  float distance = infinity;  ///< R, m: harmonic mean distance of what is seen from here, or less
  float least = 0;            ///< m, what R counts as at least
  Spectrum irradiance;
  SpectrumGradient rotation;     ///< per change of the normal
  SpectrumGradient translation;  ///< per metre

  float radius() const { return std::max(distance, least); }
  /// Extrapolated by the gradients, that of position as far as R is not longer than it should be. The products of
  /// normals in Ward & Heckbert's form cancel, because `rotation` is perpendicular to `normal`.
  Spectrum at(const Point& p, const Normal& n) const {
    const float trust = distance < least ? distance / least : 1.0f;
    return irradiance + rotation.along(n) + translation.along(p - position) * trust;
  }
};

/// The hemisphere about local z in cells of equal cosine-weighted solid angle: rings and, about π times as many,
/// sectors.
class HemisphereGrid {
 public:
  /// Of about so many cells, four at least.
  explicit HemisphereGrid(int cells);

  int rings() const { return rings_; }
  int sectors() const { return sectors_; }
  int cells() const { return rings_ * sectors_; }
  /// Direction in a cell, by density cos/π over all cells; those of a ring follow each other.
  Vec3 direction(int cell, const Vec2& u) const;

 private:
  int rings_, sectors_;
};

/// What a ray has found.
struct HemisphereRay {
  Spectrum radiance;
  float distance = infinity;  ///< m, of what it hit first
};

/// A record of everything but a position: irradiance, both gradients and distance, by one ray for each cell. The
/// distance is the harmonic mean, and no more than what the translational gradient needs to take all light away.
/// `frame`: the grid's, in world space.
IrradianceRecord estimate_irradiance(const HemisphereGrid& grid, std::span<const HemisphereRay> rays,
                                     const Frame& frame);

}  // namespace lanthorn
