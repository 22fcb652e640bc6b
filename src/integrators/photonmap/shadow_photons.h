// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "index/bucket_kdtree.h"
#include "path/light_pass.h"
#include "path/path_draw.h"

namespace lanthorn {

/// Visibility of a light from a point, as far as it is known.
enum class Lighting : std::uint8_t { unknown, lit, shadowed };

/// Shadow photons (Jensen & Christensen 1995, "Efficiently Rendering Shadows using the Photon Map"). Photons fly along
/// straight rays through all surfaces. Each stores a lit photon on the first surface and a shadow photon on every
/// surface behind it. If all photons of a light around a point are of one kind, so is the point. Interfaces between
/// media occlude nothing. Immutable.
class ShadowPhotons {
 public:
  /// Number of photons of a light around a point that must agree, and number of photons that are inspected.
  static constexpr std::size_t least_agreeing = 24, most_looked_at = 64;

  /// Adds the rays traced to `counts`.
  static ShadowPhotons trace(const Scene& scene, const LightPass& pass, const PassDraw& draw, RayCounts& counts);

  /// Visibility at a surface point, for light from the side of `normal` (unit), by the photons within `radius`, m.
  Lighting at(const Point& p, const Normal& normal, std::uint32_t light, float radius) const;

  /// Share of lit photons among those around the point, for all lights. Empty if there are no photons.
  std::optional<float> lit_share(const Point& p, const Normal& normal, float radius) const;

  std::size_t size() const { return records_.size(); }
  std::size_t memory_bytes() const { return index_.memory_bytes() + records_.size() * sizeof(Record); }

 private:
  struct Record {
    std::uint32_t light = 0;
    std::uint32_t normal = 0;  ///< octahedral, on the side of the photon's origin
    bool lit = false;
  };
  struct Chunk {
    std::vector<Point> positions;
    std::vector<Record> records;
  };
  /// Calls `visit(record)` for the nearest photons on the surface, until it returns false.
  template <class Visit>
  void for_each_around(const Point& p, const Normal& normal, float radius, Visit&& visit) const;
  static void follow(const PathContext& path, const LightPath& start, float time, Chunk& to);

  BucketKdTree index_;
  std::vector<Record> records_;
};

}  // namespace lanthorn
