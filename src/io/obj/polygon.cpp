// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/obj/polygon.h"

#include <numeric>

#include "math/vec.h"

namespace lanthorn::obj {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

// Ear clipping takes time proportional to the cube of the number of corners.
constexpr std::size_t most_corners = 1000;

// Projects the polygon into its plane, counter-clockwise.
std::vector<glm::dvec2> flattened(const std::vector<Point>& corners, const glm::dvec3& normal) {
  const glm::dvec3 n = glm::abs(normal);
  const int z = n.x > n.y && n.x > n.z ? 0 : n.y > n.z ? 1 : 2;
  const int x = (z + 1) % 3, y = (z + 2) % 3;
  const double turn = normal[z] < 0 ? -1 : 1;
  std::vector<glm::dvec2> result;
  result.reserve(corners.size());
  for (const Point& p : corners) result.emplace_back(p[x], turn * static_cast<double>(p[y]));
  return result;
}

double twice_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_inside(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return twice_area(a, b, p) >= 0 && twice_area(b, c, p) >= 0 && twice_area(c, a, p) >= 0;
}

// True if `left[i]` is an ear: the polygon is convex there, and no other corner lies in the triangle.
bool is_ear(const std::vector<glm::dvec2>& flat, const std::vector<std::uint32_t>& left, std::size_t i) {
  const std::size_t n = left.size();
  const std::uint32_t before = left[(i + n - 1) % n], here = left[i], after = left[(i + 1) % n];
  if (!(twice_area(flat[before], flat[here], flat[after]) > 0)) return false;
  for (const std::uint32_t other : left) {
    const bool is_corner = flat[other] == flat[before] || flat[other] == flat[here] || flat[other] == flat[after];
    if (!is_corner && is_inside(flat[other], flat[before], flat[here], flat[after])) return false;
  }
  return true;
}

std::vector<Triangle> fan(std::size_t corners) {
  std::vector<Triangle> result;
  for (std::uint32_t i = 1; i + 1 < corners; ++i) result.push_back({0, i, i + 1});
  return result;
}

}  // namespace

glm::dvec3 area_vector(const std::vector<Point>& corners) {
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += glm::cross(glm::dvec3(corners[i] - corners[0]), glm::dvec3(corners[(i + 1) % corners.size()] - corners[0]));
  return 0.5 * sum;
}

std::vector<Triangle> triangulate(const std::vector<Point>& corners, std::uint64_t& tests_left) {
  const std::size_t n = corners.size();
  if (n <= 3 || n > most_corners) return fan(n);
  const std::vector<glm::dvec2> flat = flattened(corners, area_vector(corners));
  std::vector<std::uint32_t> left(n);
  std::iota(left.begin(), left.end(), 0u);
  std::vector<Triangle> result;
  std::size_t i = 1, tried = 0;
  while (left.size() > 3) {
    if (tried == left.size()) return fan(n);
    const std::size_t m = left.size();
    if (tests_left < m) return fan(n);
    tests_left -= m;
    if (!is_ear(flat, left, i % m)) {
      ++i;
      ++tried;
      continue;
    }
    i %= m;
    result.push_back({left[(i + m - 1) % m], left[i], left[(i + 1) % m]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    ++i;  // skips a corner, which avoids slivers
    tried = 0;
  }
  result.push_back({left[0], left[1], left[2]});
  return result;
}

}  // namespace lanthorn::obj
