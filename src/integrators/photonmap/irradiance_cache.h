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

/// Irradiance where it has been computed, for the points between (Ward, Rubinstein & Clear 1988, "A Ray Tracing
/// Solution for Diffuse Interreflection"). Any number of threads may query it while nothing is inserted.
class IrradianceCache {
 public:
  /// `find` uses records so many times farther away than `covers`: where one is good enough, several are smoothed.
  static constexpr float smoothing = 2.0f;

  IrradianceCache() = default;
  /// `error`: Ward's a, the estimate of the relative error up to which a record covers a point.
  IrradianceCache(const Bounds& scene, float error) : error_(error), valid_(scene), reach_(scene) {}

  /// Adds a record. Its distance, and those of the records around, are first made no longer than a neighbour's and the
  /// way there: what is near to a neighbour is not far from here (Křivánek et al. 2006, "Making Radiance and Irradiance
  /// Caching Practical: Adaptive Caching and Neighbor Clamping").
  void insert(IrradianceRecord record);

  /// True if a record is good enough for the point: of an estimated error below `limit`, at most `smoothing` times the
  /// cache's.
  bool covers(const Point& p, const Normal& normal, float limit) const;
  bool covers(const Point& p, const Normal& normal) const { return covers(p, normal, error_); }
  /// Irradiance, W/m², interpolated with the gradients; nothing where no record is near enough.
  std::optional<Spectrum> find(const Point& p, const Normal& normal) const;

  /// Calls `visit(record, e)` for the records whose estimated error e at the point is below `limit`, which is at most
  /// `smoothing` times the cache's.
  template <class Visit>
  void for_each_valid(const Point& p, const Normal& normal, float limit, Visit&& visit) const {
    if (records_.empty()) return;
    valid_.for_each_around(p, [&](std::uint32_t id) {
      const IrradianceRecord& record = records_[id];
      if (distance_squared(p, record.position) > sqr(limit * record.radius())) return;  // most of them
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
  SphereOctree valid_;  // where the records are used
  SphereOctree reach_;  // how far their distances are
};

}  // namespace lanthorn
