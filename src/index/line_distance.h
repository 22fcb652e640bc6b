// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Distances between points and lines, computed in double precision, so that only the single-precision rounding of the
// input remains as error, however far away a line begins.
#pragma once

#include <cmath>
#include <optional>

#include "math/vec.h"

namespace lanthorn {

/// Part of a line: the points origin + t · direction with t in [begin, end] (m).
struct RaySegment {
  Point origin{0};
  Direction direction{0, 0, 1};
  float begin = 0;
  float end = infinity;
};

/// Projection of a point onto a line: parameter of its foot point, and the squared distance (m²).
struct FootPoint {
  double t, dist2;
};

inline FootPoint foot_on_line(const Point& p, const Point& origin, const Direction& direction) {
  const glm::dvec3 d(direction), w = glm::dvec3(p) - glm::dvec3(origin);
  const double t = dot(w, d) / dot(d, d);
  const glm::dvec3 across = w - t * d;
  return {t, dot(across, across)};
}

/// The closest points of two lines: parameters on the first and the second, squared distance (m²), and the sine of the
/// angle between the lines.
struct LineCrossing {
  double t, s, dist2, sin;
};

/// nullopt if the lines are parallel and therefore have no closest points. With n = d × e and w from the first origin
/// to the second, o + t d + h n = a + s e gives t = (w × e)·n / n², s = (w × d)·n / n², and the distance |w·n| /
/// n|.
inline std::optional<LineCrossing> closest_points(const Point& o, const Direction& direction, const Point& a,
                                                  const Direction& other) {
  const glm::dvec3 d(direction), e(other), w = glm::dvec3(a) - glm::dvec3(o), n = cross(d, e);
  const double n2 = dot(n, n);
  if (n2 == 0) return {};
  return LineCrossing{dot(cross(w, e), n) / n2, dot(cross(w, d), n) / n2, sqr(dot(w, n)) / n2, std::sqrt(n2)};
}

}  // namespace lanthorn
