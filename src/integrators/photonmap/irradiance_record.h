// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Irradiance at a point and its gradients, from rays over the hemisphere (Ward & Heckbert 1992, "Irradiance
// Gradients").
#pragma once

#include <span>

#include "math/frame.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Gradient of a spectrum with respect to a vector.
struct SpectrumGradient {
  Spectrum x, y, z;

  Spectrum along(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
  void add(const Vec3& direction, const Spectrum& s) {
    x += s * direction.x;
    y += s * direction.y;
    z += s * direction.z;
  }
};

/// Irradiance, W/m², at a point on a surface, with the data for extrapolation around it.
struct IrradianceRecord {
  Point position{0};
  Normal normal{0, 0, 1};     ///< on the illuminated side
  float distance = infinity;  ///< R, m: harmonic mean distance of visible surfaces, or less
  float least = 0;            ///< lower bound of R, m
  Spectrum irradiance;
  SpectrumGradient rotation;     ///< with respect to the normal
  SpectrumGradient translation;  ///< with respect to position, per metre

  float radius() const { return std::max(distance, least); }
  /// Irradiance extrapolated by the gradients. The translational gradient is scaled down where `least` exceeds
  /// `distance`. The cross product in Ward & Heckbert's form is not needed, because `rotation` is perpendicular to
  /// `normal`.
  Spectrum at(const Point& p, const Normal& n) const {
    const float trust = distance < least ? distance / least : 1.0f;
    return irradiance + rotation.along(n) + translation.along(p - position) * trust;
  }
};

/// The hemisphere about local z, divided into cells of equal cosine-weighted solid angle: rings, and about π times as
/// many sectors.
class HemisphereGrid {
 public:
  /// About `cells` cells, at least four.
  explicit HemisphereGrid(int cells);

  int rings() const { return rings_; }
  int sectors() const { return sectors_; }
  int cells() const { return rings_ * sectors_; }
  /// Direction in a cell. The density over all cells is cos/π. The cells of a ring are consecutive.
  Vec3 direction(int cell, const Vec2& u) const;

 private:
  int rings_, sectors_;
};

/// Result of one ray.
struct HemisphereRay {
  Spectrum radiance;
  float distance = infinity;  ///< to the first hit, m
};

/// A record without its position: irradiance, both gradients and distance, from one ray for each cell. The distance is
/// the harmonic mean, limited to the distance at which the translational gradient would bring the irradiance to zero.
/// `frame`: of the grid, in world space.
IrradianceRecord estimate_irradiance(const HemisphereGrid& grid, std::span<const HemisphereRay> rays,
                                     const Frame& frame);

}  // namespace lanthorn
