// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Displaced meshes have edges that are short enough, no cracks, and the given height.
#include "shape/displacement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "support/error_text.h"
#include "support/scene_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::displacement_test {
namespace {

using description::BilinearMesh;
using description::TriangleMesh;

BilinearMesh unit_square() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {}, {{0, 0}, {1, 0}, {0, 1}, {1, 1}}, {{0, 1, 2, 3}}};
}

TEST(Displacement, SplitsUntilNoEdgeIsTooLong) {
  const Transform to_world = scale({2, 3, 1});
  const auto flat = [](const TexturePoint&) { return 0.0f; };
  const TriangleMesh mesh = displaced(triangulated(unit_square()), 0.3f, to_world, flat, {});
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double area = 0;
  for (const auto& t : mesh.triangles) {
    for (unsigned i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      EXPECT_LE(distance_squared(to_world.point(mesh.positions[a]), to_world.point(mesh.positions[b])), 0.0901f);
      ++edges[std::minmax(a, b)];
    }
    const Vec3 n = cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    EXPECT_GT(n.z, 0) << "turned over";
    area += 0.5 * std::sqrt(static_cast<double>(length_squared(n)));
  }
  EXPECT_NEAR(area, 1, 1e-5);
  // No cracks: each inner edge belongs to two triangles, and no two vertices have the same position.
  for (const auto& [edge, count] : edges) {
    const Point middle = 0.5f * (mesh.positions[edge.first] + mesh.positions[edge.second]);
    const bool border = middle.x == 0 || middle.x == 1 || middle.y == 0 || middle.y == 1;
    EXPECT_EQ(count, border ? 1 : 2);
  }
  auto sorted = mesh.positions;
  std::sort(sorted.begin(), sorted.end(),
            [](const Point& a, const Point& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
}

TEST(Displacement, MovesAlongNormalsAndRenewsThem) {
  const auto ramp = [](const TexturePoint& at) { return 0.5f * at.uv.x + 0.01f * at.position.z; };
  const Transform to_world = translate({0, 0, 10});
  const TriangleMesh mesh = displaced(triangulated(unit_square()), 0.2f, to_world, ramp, {});
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_NEAR(mesh.positions[i].z, 0.5f * mesh.positions[i].x + 0.1f, 1e-5f);
    const Normal n = normalize(mesh.normals[i]);
    EXPECT_NEAR(n.x, -0.5f / std::sqrt(1.25f), 1e-4f);
    EXPECT_NEAR(n.z, 1 / std::sqrt(1.25f), 1e-4f);
  }
}

// The normals of the file say which side is outside, not the order of the corners.
TEST(Displacement, KeepsTheOutside) {
  const auto ramp = [](const TexturePoint& at) { return 0.5f * at.uv.x; };
  TriangleMesh square = triangulated(unit_square());
  square.normals.assign(square.positions.size(), {0, 0, -1});
  const TriangleMesh mesh = displaced(square, 0.2f, {}, ramp, {});
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_NEAR(mesh.positions[i].z, -0.5f * mesh.positions[i].x, 1e-5f);
    EXPECT_LT(mesh.normals[i].z, 0);
  }
}

TEST(Displacement, TooFineIsAnError) {
  const auto flat = [](const TexturePoint&) { return 0.0f; };
  EXPECT_THROW(displaced(triangulated(unit_square()), 1e-9f, {}, flat, {"s.pbrt", 1, 1}), Error);
}

TEST(Displacement, OfPlyMeshesInScenes) {
  const test::TemporaryDir folder;
  folder.write(
      "square.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property float u\nproperty float v\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n");
  const Scene scene = test::world(
      R"(Texture "ramp" "float" "bilerp" "float v00" 0 "float v10" 1 "float v01" 0 "float v11" 1
Shape "plymesh" "string filename" "square.ply" "texture displacement" "ramp" "float edgelength" 0.1
)",
      "", folder.path().string());
  const auto at = test::look(scene, {0.3f, 0.6f, 5}, {0, 0, -1});
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->position.z, 0.3f, 1e-4f);
  EXPECT_GT(scene.statistics().triangles, 200u);
}

// Far from the origin, an edge's midpoint is rounded to one of its ends, in object space or in world space.
TEST(Displacement, RefusesEdgesShorterThanSinglePrecisionKnows) {
  const auto flat = [](const TexturePoint&) { return 0.0f; };
  const SourceLocation here{"t.pbrt", 3, 1};
  const std::string refused =
      "t.pbrt:3:1: the edge length of the displacement is too short for single precision, this far from the origin";
  EXPECT_EQ(test::error_text([&] {
              displaced(triangulated(unit_square()), 0.1f, translate({1e8f, 0, 0}), flat, here);
            }),
            refused);
  BilinearMesh far = unit_square();
  for (Point& p : far.positions) p = 64.0f * p + Vec3(1e8f, 0, 0);
  EXPECT_EQ(test::error_text([&] { displaced(triangulated(far), 1, translate({-1e8f, 0, 0}), flat, here); }), refused);
  EXPECT_EQ(test::error_text([&] {
              displaced(triangulated(far), 16, translate({-1e8f, 0, 0}), flat, here);
            }),
            "no error");
}

// Refused before the first triangle is made.
TEST(Displacement, RefusesTooManyTrianglesInAll) {
  const test::TemporaryDir dir;
  dir.write("a.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  std::string text = R"(Texture "t" "float" "fbm"
)";
  for (int i = 0; i < 6; ++i)  // 13 million triangles each
    text +=
        R"(Shape "plymesh" "string filename" "a.ply" "texture displacement" "t" "float edgelength" 0.0003
)";
  EXPECT_EQ(test::error_text([&] { test::world(text, "", dir.path().string()); }),
            "test scene:10:1: the scene's displacements make more than 67 million triangles together");
}

}  // namespace
}  // namespace lanthorn::displacement_test
