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

/// What is known of a light's way to a place.
enum class Lighting : std::uint8_t { unknown, lit, shadowed };

/// Photons on the straight ways of direct light, which go on through all that they meet (Jensen & Christensen 1995,
/// "Efficiently Rendering Shadows using the Photon Map"): each lights the first surface and is a shadow photon on all
/// behind it. Where all photons of a light around a point are of one kind, so is the point. Borders of media stop
/// nothing. Immutable.
class ShadowPhotons {
 public:
  /// So many photons of a light must agree, of those around a point that are looked at.
  static constexpr std::size_t least_agreeing = 24, most_looked_at = 64;

  /// `counts` gets the rays.
  static ShadowPhotons trace(const Scene& scene, const LightPass& pass, const PathDraw& draw, RayCounts& counts);

  /// At a surface point, for light that comes in from the side of `normal` (unit). Photons within `radius`, m, count.
  Lighting at(const Point& p, const Normal& normal, std::uint32_t light, float radius) const;

  /// Share of the photons around the point that are lit, of all lights; nothing where there are none.
  std::optional<float> lit_share(const Point& p, const Normal& normal, float radius) const;

  std::size_t size() const { return records_.size(); }
  std::size_t memory_bytes() const { return index_.memory_bytes() + records_.size() * sizeof(Record); }

 private:
  struct Record {
    std::uint32_t light = 0;
    std::uint32_t normal = 0;  ///< octahedral, on the side that the photon came from
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
