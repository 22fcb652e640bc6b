// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "ibl/sun_coverage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace lanthorn {

namespace {

/// Corners in the plane of a face, in units of the map's texels from the upper left corner.
using Polygon = std::vector<glm::dvec2>;

/// Clips the polygon to the half-plane sign · (coordinate - limit) >= 0 along an axis (Sutherland & Hodgman 1974).
Polygon clipped(const Polygon& polygon, int axis, double sign, double limit) {
  Polygon kept;
  const auto side = [&](const glm::dvec2& p) { return sign * (p[axis] - limit); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double from = side(a), to = side(b);
    if (from >= 0) kept.push_back(a);
    if ((from < 0) != (to < 0)) {
      glm::dvec2 crossing = a + from / (from - to) * (b - a);
      crossing[axis] = limit;  // so that a polygon that fills a texel becomes exactly the texel
      kept.push_back(crossing);
    }
  }
  return kept;
}

/// Solid angle of a polygon on a face of a map of `size`, sr: the sum over a triangle fan (Van Oosterom & Strackee
/// 1983).
double solid_angle_of(const Polygon& polygon, int size) {
  std::vector<glm::dvec3> corners;
  corners.reserve(polygon.size());
  for (const glm::dvec2& p : polygon) corners.emplace_back(2.0 / size * p - 1.0, 1.0);
  double sum = 0;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const glm::dvec3 &a = corners[0], &b = corners[i - 1], &c = corners[i];
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    // The triple product of three points at height 1.
    const double volume = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    sum += 2 * std::atan2(volume, la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return std::fabs(sum);
}

/// A rectangle of the image, in texels.
struct ImagePart {
  float x, y, width, height;
};

/// Directions along its border. Horizontal lines of equirectangular images are curves on a face.
std::vector<Direction> outline_of(const Environment& environment, const ImagePart& part) {
  constexpr int steps = 4;  // along each side
  std::vector<Direction> outline;
  const auto side = [&](float x, float y, float dx, float dy) {
    for (int i = 0; i < steps; ++i) {
      const float t = static_cast<float>(i) / steps;
      outline.push_back(
          environment.direction_at(part.x + (x + t * dx) * part.width, part.y + (y + t * dy) * part.height));
    }
  };
  side(0, 0, 1, 0);
  side(1, 0, 0, 1);
  side(1, 1, -1, 0);
  side(0, 1, 0, -1);
  return outline;
}

/// The outline projected onto the plane of a face. Empty if it is not near this face; requires a small outline.
Polygon on_face(const std::vector<Direction>& outline, int face, int size) {
  Polygon polygon;
  for (const Direction& d : outline) {
    const std::optional<Vec2> place = place_on_face(face, d);
    if (!place) return {};
    polygon.push_back(static_cast<double>(size) * glm::dvec2(*place));
  }
  return polygon;
}

/// Adds `excess` where the polygon covers the face.
void add_polygon(const Polygon& polygon, const Spectrum& excess, int face, const std::vector<float>& solid_angles,
                 CubeMap& map) {
  if (polygon.empty()) return;
  const int size = map.size();
  glm::dvec2 low(size), high(0);
  for (const glm::dvec2& p : polygon) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const auto begin = [&](double v) { return static_cast<int>(std::floor(std::max(v, 0.0))); };
  const auto end = [&](double v) { return static_cast<int>(std::ceil(std::min(v, static_cast<double>(size)))); };
  for (int y = begin(low.y); y < end(high.y); ++y) {
    const Polygon row = clipped(clipped(polygon, 1, 1, y), 1, -1, y + 1);
    for (int x = begin(low.x); x < end(high.x); ++x) {
      const double covered = solid_angle_of(clipped(clipped(row, 0, 1, x), 0, -1, x + 1), size);
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
      map.texel(face, x, y) += excess * (static_cast<float>(covered) / solid_angles[i]);
    }
  }
}

}  // namespace

void add_suns(const Environment& environment, CubeMap& map) {
  const std::vector<float> solid_angles = cube_solid_angles(map.size());
  constexpr float widest = 0.1f;  // widest part, rad
  const float texel_width = 0.5f * pi / environment.texels_per_face();
  const int parts = std::max(1, static_cast<int>(std::ceil(texel_width / widest)));
  const float step = 1 / static_cast<float>(parts);
  const auto place = [&](int texel, int part) { return static_cast<float>(texel) + static_cast<float>(part) * step; };
  for (const Environment::Sun& sun : environment.suns())
    for (int j = 0; j < parts; ++j)
      for (int i = 0; i < parts; ++i) {
        const std::vector<Direction> outline = outline_of(environment, {place(sun.x, i), place(sun.y, j), step, step});
        for (int face = 0; face < cube_faces; ++face)
          add_polygon(on_face(outline, face, map.size()), sun.excess, face, solid_angles, map);
      }
}

}  // namespace lanthorn
