// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "lanthorn/scene.h"

namespace lanthorn::scene_memory_test {
namespace {

// A height field of 2 · 150² triangles.
description::TriangleMesh field(bool has_normals) {
  constexpr std::uint32_t n = 150;
  description::TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) {
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      mesh.positions.emplace_back(fx, fy, std::sin(fx * fy));
      if (has_normals) mesh.normals.emplace_back(0, 0, 1);
    }
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t i = y * (n + 1) + x;
      mesh.triangles.push_back({i, i + 1, i + n + 1});
      mesh.triangles.push_back({i + 1, i + n + 2, i + n + 1});
    }
  return mesh;
}

SceneDescription scene_of(const description::TriangleMesh& mesh) {
  SceneDescription scene;
  scene.materials.emplace_back();
  scene.shapes.emplace_back().geometry = mesh;
  return scene;
}

TEST(SceneMemory, IsKnownBeforeTheSceneIsBuilt) {
  for (const bool has_normals : {false, true}) {
    SceneDescription scene = scene_of(field(has_normals));
    const SceneMemory expected = expected_memory(scene);
    EXPECT_EQ(expected.triangles, 45000u);
    const SceneSummary actual = summarize(*build_scene(std::move(scene)));
    EXPECT_NEAR(expected.geometry / static_cast<double>(actual.geometry_bytes), 1, .01) << has_normals;
    EXPECT_NEAR(expected.trees / static_cast<double>(actual.bvh_bytes), 1, .2) << has_normals;
  }
}

TEST(SceneMemory, ObjectsCountOnceAndTheLargestTreeIsBuiltBesideTheOthers) {
  SceneDescription scene = scene_of(field(false));
  const SceneMemory one = expected_memory(scene);
  scene.objects.emplace_back().shapes = scene.shapes;
  scene.instances.resize(1000);
  const SceneMemory two = expected_memory(scene);
  EXPECT_DOUBLE_EQ(two.geometry, 2 * one.geometry);
  EXPECT_DOUBLE_EQ(two.trees, 2 * one.trees);
  EXPECT_DOUBLE_EQ(two.building, one.building);
}

}  // namespace
}  // namespace lanthorn::scene_memory_test
