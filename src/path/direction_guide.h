// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "math/distribution.h"
#include "math/frame.h"
#include "math/vec.h"

namespace lanthorn {

/// A density of directions over a hemisphere, from flux that was seen to come in (Jensen 1995, "Importance Driven Path
/// Tracing using the Photon Map"). The hemisphere is projected onto its disc, and the disc mapped to a square without
/// change of areas: cells have equal projected solid angle, so that flux in a cell is proportional to its mean radiance
/// times the cosine, and an even grid is the cosine's density.
class DirectionGuide {
 public:
  /// Flux that came from a direction, in any unit, >= 0.
  struct Seen {
    Direction from;
    float flux;
  };

  DirectionGuide() = default;
  /// What came from below the horizon of `normal` does not count.
  DirectionGuide(const Normal& normal, std::span<const Seen> light);

  /// Draws a direction, world space; none if no light is known.
  std::optional<Direction> sample(const Vec2& u) const;
  /// Its density, per solid angle.
  float pdf(const Direction& direction) const;

  /// Memory beside the object itself, bytes.
  static std::size_t table_bytes();

 private:
  Frame frame_;
  PiecewiseConstant2d density_;
};

}  // namespace lanthorn
