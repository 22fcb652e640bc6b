// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes of many files, which are read and decoded concurrently. Run it mainly under ThreadSanitizer (scripts/test
// --tsan).
#include <gtest/gtest.h>

#include <string>

#include "lanthorn/scene.h"
#include "support/gltf_writer.h"
#include "support/jpeg.h"
#include "support/temporary_dir.h"

namespace lanthorn::parallel_loading_test {
namespace {

constexpr int files = 24;

TEST(ParallelLoading, MeshesAndTexturesOfPbrt) {
  const test::TemporaryDir dir;
  const std::string jpeg = test::grey_jpeg();
  const std::string mesh =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  std::string scene = R"(Camera "perspective"
WorldBegin
)";
  for (int i = 0; i < files; ++i) {
    const std::string n = std::to_string(i);
    dir.write(n + ".jpg", test::with_profile(jpeg, test::profile_of_unknown_tags(static_cast<std::size_t>(i))));
    dir.write(n + ".ply", mesh);
    scene += "Texture \"t" + n + R"(" "spectrum" "imagemap" "string filename" ")" + n + ".jpg\"\n" +
             R"(Material "diffuse" "texture reflectance" "t)" + n + "\"\n" + R"(Shape "plymesh" "string filename" ")" +
             n + ".ply\"\n";
  }
  const SharedScene loaded = build_scene(read_scene(dir.write("a.pbrt", scene)));
  const SceneSummary summary = summarize(*loaded);
  EXPECT_EQ(summary.triangles, static_cast<std::size_t>(files));
  EXPECT_EQ(summary.textures, static_cast<std::size_t>(files));
  EXPECT_EQ(summary.texture_bytes, static_cast<std::uint64_t>(files) * 8 * 8 * 3);
}

TEST(ParallelLoading, MeshesAndTexturesOfGltf) {
  const test::TemporaryDir dir;
  const std::string jpeg = test::grey_jpeg();
  test::GltfWriter gltf;
  for (int i = 0; i < files; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const std::size_t bytes = gltf.view(test::with_profile(jpeg, test::profile_of_unknown_tags(1000 + n)));
    const std::size_t image = gltf.add("images", {{"bufferView", bytes}, {"mimeType", "image/jpeg"}});
    const std::size_t texture = gltf.add("textures", {{"source", image}});
    const std::size_t material =
        gltf.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    const std::size_t places = gltf.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    const std::size_t corners = gltf.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, 2);
    const nlohmann::json primitive{{"attributes", {{"POSITION", places}, {"TEXCOORD_0", corners}}},
                                   {"material", material}};
    const std::size_t mesh = gltf.add("meshes", {{"primitives", nlohmann::json::array({primitive})}});
    gltf.add("nodes", {{"mesh", mesh}});
  }
  nlohmann::json nodes = nlohmann::json::array();
  for (int i = 0; i < files; ++i) nodes.push_back(i);
  gltf.add("scenes", {{"nodes", nodes}});
  const SharedScene loaded = build_scene(read_scene(dir.write("a.gltf", gltf.text())));
  const SceneSummary summary = summarize(*loaded);
  EXPECT_EQ(summary.triangles, static_cast<std::size_t>(files));
  EXPECT_EQ(summary.texture_bytes, static_cast<std::uint64_t>(files) * 8 * 8 * 3);
}

}  // namespace
}  // namespace lanthorn::parallel_loading_test
