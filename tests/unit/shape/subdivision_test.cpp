// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Loop subdivision against known properties of its limit surface.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "math/hash.h"
#include "shape/loop_subdivision.h"

namespace lanthorn::subdivision_test {
namespace {

using description::TriangleMesh;

TriangleMesh octahedron() {
  TriangleMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

// n x n squares, cut into triangles, seen counter-clockwise from +z; inner vertices have valence 6.
TriangleMesh grid(std::uint32_t n) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) {
      mesh.positions.emplace_back(x, y, 0);
      if (x == n || y == n) continue;
      const std::uint32_t a = y * (n + 1) + x, b = a + n + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

void shake(TriangleMesh& mesh) {
  HashRng rng(1);
  for (Point& p : mesh.positions) p += 0.3f * (Vec3(rng.next(), rng.next(), rng.next()) - 0.5f);
}

// The masks give the octahedron's vertices the limit (1 - 4 g) v with g = 1 / (4 + 3 / (8 * 3 / 32)) = 1 / 8.
TEST(LoopSubdivision, OctahedronsVerticesGoHalfWay) {
  for (int levels = 0; levels < 4; ++levels) {
    const TriangleMesh control = octahedron(), mesh = loop_subdivide(control, levels);
    EXPECT_EQ(mesh.triangles.size(), control.triangles.size() << (2 * levels));
    EXPECT_EQ(mesh.positions.size(), mesh.triangles.size() / 2 + 2);  // Euler
    for (std::size_t i = 0; i < control.positions.size(); ++i) {
      EXPECT_LT(distance_squared(mesh.positions[i], 0.5f * control.positions[i]), 1e-12f);
      EXPECT_NEAR(dot(mesh.normals[i], control.positions[i]), -1, 1e-5f);  // pbrt's side: against the winding
    }
  }
}

// Subdivision does not change the limit surface, so masks, rules and tangents are consistent. The meshes have valences
// 3 to 6 and all kinds of boundary vertices.
TEST(LoopSubdivision, LimitsDoNotDependOnTheLevel) {
  TriangleMesh solid = octahedron(), sheet = grid(4), tetrahedron;
  tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  sheet.triangles.pop_back();  // a notch
  for (TriangleMesh* control : {&solid, &sheet, &tetrahedron}) {
    shake(*control);
    const TriangleMesh expected = loop_subdivide(*control, 0);
    const std::vector<bool> used = [&] {
      std::vector<bool> result(control->positions.size());
      for (const auto& face : control->triangles)
        for (const std::uint32_t v : face) result[v] = true;
      return result;
    }();
    for (int levels = 1; levels <= 4; ++levels) {
      const TriangleMesh mesh = loop_subdivide(*control, levels);
      for (std::size_t i = 0; i < control->positions.size(); ++i) {
        EXPECT_LT(distance_squared(mesh.positions[i], expected.positions[i]), 1e-12f) << i << " at level " << levels;
        if (used[i]) {
          EXPECT_GT(dot(mesh.normals[i], expected.normals[i]), 0.99f) << i << " at level " << levels;
        }
      }
    }
  }
}

TEST(LoopSubdivision, BoundariesAreCubicSplines) {
  TriangleMesh control = grid(6);
  shake(control);
  const TriangleMesh mesh = loop_subdivide(control, 1);
  const auto p = [&](int i) { return control.positions[static_cast<std::size_t>(i)]; };
  // The spline at the midpoint between the boundary's vertices 2 and 3.
  const Point expected = (p(1) + 23.0f * p(2) + 23.0f * p(3) + p(4)) / 48.0f;
  float nearest = infinity;
  for (const Point& q : mesh.positions) nearest = std::min(nearest, distance_squared(q, expected));
  EXPECT_LT(nearest, 1e-12f);
  EXPECT_LT(distance_squared(mesh.positions[3], (p(2) + 4.0f * p(3) + p(4)) / 6.0f), 1e-12f);
}

// A plane stays a plane, with even spacing where all valences are 6.
TEST(LoopSubdivision, ReproducesPlanes) {
  const TriangleMesh mesh = loop_subdivide(grid(5), 2);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_EQ(mesh.positions[i].z, 0);
    EXPECT_NEAR(mesh.normals[i].z, -1, 1e-6f);
  }
  EXPECT_LT(distance_squared(mesh.positions[2 * 6 + 2], {2, 2, 0}), 1e-12f);
}

TEST(LoopSubdivision, SurvivesWhatIsNoSurface) {
  TriangleMesh book;  // three pages on one edge, a degenerate triangle, two of opposite winding, a single one
  HashRng rng(2);
  for (int i = 0; i < 12; ++i) book.positions.emplace_back(rng.next(), rng.next(), rng.next());
  book.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {5, 5, 6}, {5, 6, 7}, {5, 6, 8}, {9, 10, 11}};
  const TriangleMesh mesh = loop_subdivide(book, 3);
  EXPECT_EQ(mesh.triangles.size(), 6u * 64);
  for (const Point& p : mesh.positions) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
  for (const Normal& n : mesh.normals) EXPECT_TRUE(std::isfinite(n.x + n.y + n.z));
  EXPECT_EQ(loop_subdivide({}, 2).triangles.size(), 0u);
}

}  // namespace
}  // namespace lanthorn::subdivision_test
