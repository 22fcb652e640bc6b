// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>

#include "lanthorn/scene.h"
#include "math/hash.h"
#include "support/temporary_dir.h"

namespace lanthorn::scene_memory_test {
namespace {

// A height field with 2 · 150² triangles.
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

TEST(SceneMemory, CountsCurves) {
  for (const auto kind : {description::CurveKind::flat, description::CurveKind::ribbon}) {
    description::Curves curves;
    curves.kind = kind;
    HashRng rng(1);
    for (std::uint32_t i = 0; i < 20'000; ++i) {
      curves.segments.push_back(static_cast<std::uint32_t>(curves.points.size()));
      for (int k = 0; k < 4; ++k) {
        const float x = rng.next(), y = rng.next();
        curves.points.emplace_back(x, y, .1f * static_cast<float>(k), .001f);
        if (kind == description::CurveKind::ribbon) curves.normals.emplace_back(0, 1, 0);
      }
    }
    SceneDescription scene;
    scene.materials.emplace_back();
    scene.shapes.emplace_back().geometry = curves;
    const SceneMemory expected = expected_memory(scene);
    const SceneSummary actual = summarize(*build_scene(std::move(scene)));
    EXPECT_NEAR(expected.geometry / static_cast<double>(actual.geometry_bytes), 1, .02);
    EXPECT_NEAR(expected.trees / static_cast<double>(actual.bvh_bytes), 1, .3);
  }
}

TEST(SceneMemory, ImagesOfTexturesByTheirHeaders) {
  const test::TemporaryDir folder;
  const std::string path = (folder.path() / "a.ppm").string();
  std::ofstream(path) << "P6\n30 20\n255\n" << std::string(30 * 20 * 3, 'x');
  SceneDescription scene = scene_of(field(false));
  description::ImageTexture image;
  for (const char* name : {"a.ppm", "a.ppm", "missing.ppm"}) {
    image.filename = (folder.path() / name).string();
    scene.spectrum_textures.push_back({image, {}});
  }
  EXPECT_EQ(expected_texture_memory(scene), 30u * 20 * 3);  // counted once; the missing file counts 0
  scene.access.texture_memory = std::uint64_t{1} << 50;     // not available, but the image is small
  require_scene_memory(scene);
  scene.access.texture_memory.reset();
  require_scene_memory(scene);
  ASSERT_TRUE(scene.access.texture_memory);
  EXPECT_GT(*scene.access.texture_memory, 0u);
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
