// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "index/sphere_octree.h"
#include "integrators/photonmap/irradiance_record.h"

namespace lanthorn {

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
