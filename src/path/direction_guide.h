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

/// A density of directions over a hemisphere, learned from incident flux (Jensen 1995, "Importance Driven Path Tracing
/// using the Photon Map"). The hemisphere is projected onto the unit disc, and an equal-area map takes the disc to a
/// square. All cells of the square have the same projected solid angle. The flux in a cell is therefore proportional to
/// its mean radiance times the cosine, and a constant grid is the cosine-weighted density.
class DirectionGuide {
 public:
  /// Flux from a direction, in any unit, >= 0.
  struct Seen {
    Direction from;
    float flux;
  };

  DirectionGuide() = default;
  /// Ignores flux from below the horizon of `normal`.
  DirectionGuide(const Normal& normal, std::span<const Seen> light);

  /// Draws a direction, world space. Empty if the guide has no flux.
  std::optional<Direction> sample(const Vec2& u) const;
  /// Density of `sample`, per solid angle.
  float pdf(const Direction& direction) const;

  /// Memory of the tables, in bytes, without the object itself.
  static std::size_t table_bytes();

 private:
  Frame frame_;
  PiecewiseConstant2d density_;
};

}  // namespace lanthorn
