// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "index/sphere_octree.h"
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

/// Irradiance, W/m², at a point on a surface, with the data for extrapolation around it: gradients from rays over the
/// hemisphere (Ward & Heckbert 1992, "Irradiance Gradients").
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

/// An irradiance cache: interpolates irradiance between the points where it has been computed (Ward, Rubinstein & Clear
/// 1988, "A Ray Tracing Solution for Diffuse Interreflection"). Several threads may query it while none inserts.
class IrradianceCache {
 public:
  /// `find` uses records up to this many times the error limit of `covers`, to interpolate several of them.
  static constexpr float smoothing = 2.0f;

  IrradianceCache() = default;
  /// `error` is Ward's a: the largest estimated relative error at which a record covers a point.
  IrradianceCache(const Bounds& scene, float error) : error_(error), valid_(scene), reach_(scene) {}

  /// Adds a record. First applies neighbour clamping (Křivánek et al. 2006, "Making Radiance and Irradiance Caching
  /// Practical: Adaptive Caching and Neighbor Clamping"): by the triangle inequality, the distances of this record and
  /// of the records around it are limited to a neighbour's distance plus the distance to the neighbour.
  void insert(IrradianceRecord record);

  /// True if a record has an estimated error below `limit` at the point. `limit` is at most `smoothing` times the
  /// cache's.
  bool covers(const Point& p, const Normal& normal, float limit) const;
  bool covers(const Point& p, const Normal& normal) const { return covers(p, normal, error_); }
  /// Irradiance, W/m², interpolated with the gradients. Empty if no record is valid at the point.
  std::optional<Spectrum> find(const Point& p, const Normal& normal) const;

  /// Calls `visit(record, e)` for the records whose estimated error e at the point is below `limit`, which is at most
  /// `smoothing` times the cache's.
  template <class Visit>
  void for_each_valid(const Point& p, const Normal& normal, float limit, Visit&& visit) const {
    if (records_.empty()) return;
    valid_.for_each_around(p, [&](std::uint32_t id) {
      const IrradianceRecord& record = records_[id];
      if (distance_squared(p, record.position) > sqr(limit * record.radius())) return;  // rejects most records
      const float e = estimated_error(record, p, normal);
      if (e < limit) visit(record, e);
    });
  }

  std::span<const IrradianceRecord> records() const { return records_; }
  float error() const { return error_; }

 private:
  static float estimated_error(const IrradianceRecord& record, const Point& p, const Normal& normal);

  std::vector<IrradianceRecord> records_;
  float error_ = 0;
  SphereOctree valid_;  // spheres in which records are used
  SphereOctree reach_;  // spheres of the records' distances
};

}  // namespace lanthorn
