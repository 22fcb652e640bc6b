// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Bilinear patches with exact ray intersection.
#pragma once

#include <array>
#include <optional>

#include "math/affine.h"
#include "math/vec.h"

namespace lanthorn {

/// p(u,v) = (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11.
struct Patch {
  DVec3 p00, p10, p01, p11;

  DVec3 position(double u, double v) const {
    return (1 - v) * ((1 - u) * p00 + u * p10) + v * ((1 - u) * p01 + u * p11);
  }
  DVec3 dpdu(double v) const { return (1 - v) * (p10 - p00) + v * (p11 - p01); }
  DVec3 dpdv(double u) const { return (1 - u) * (p01 - p00) + u * (p11 - p10); }
};

struct PatchHits {
  struct Hit {
    double t = 0, u = 0, v = 0;
  };
  int count = 0;
  std::array<Hit, 2> hits;  ///< ascending in t
};
/// Hits with t in (t_min, t_max), in units of the direction's length.
PatchHits intersect(const Patch& patch, const Vec3& origin, const Vec3& direction, float t_min, float t_max);

/// Parameters (u, v) in [0,1]² of a point on the patch.
Vec2 parameters_at(const Patch& patch, const Point& point);

/// True if the four corners form a plane parallelogram to within rounding; two triangles are then the same surface with
/// the same parametrisation.
bool is_parallelogram(const Point& p00, const Point& p10, const Point& p01, const Point& p11);
/// Corners p00, p10, p01, p11 of the parallelogram whose halves are the triangles, with the same normal; nullopt if
/// they are not the halves of one.
std::optional<std::array<Point, 4>> parallelogram_of(const std::array<Point, 3>& first,
                                                     const std::array<Point, 3>& second);

}  // namespace lanthorn
