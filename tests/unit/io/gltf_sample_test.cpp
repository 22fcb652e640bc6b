// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// One file that combines the features of all other glTF tests.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "lanthorn/image_file.h"
#include "lanthorn/scene.h"
#include "support/child_process.h"
#include "support/gltf_triangle.h"
#include "support/read_gltf.h"
#include "support/render_scene.h"
#include "support/temporary_dir.h"

namespace lanthorn::gltf_sample_test {
namespace {

using namespace description;
using nlohmann::json;
using test::GltfWriter;
using test::one_mesh;
using test::read_gltf;

// A floor, a lamp and four balls, with every feature that these tests check.
GltfWriter sample() {
  GltfWriter file;
  const test::TemporaryDir dir;
  Image image;
  image.width = image.height = 2;
  image.channels = {"R", "G", "B"};
  image.pixels = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5f, 0.5f, 0.5f};
  write_image(dir.path() / "a.png", image);
  file.add("images", {{"bufferView", file.view(test::file_bytes(dir.path() / "a.png"))}, {"mimeType", "image/png"}});
  file.add("textures", {{"source", 0}});
  const json transform = {{"KHR_texture_transform", {{"scale", {4, 4}}, {"rotation", 0.5}}}};
  const auto pbr = [](json base, double metallic, double roughness) {
    return json{{"baseColorFactor", std::move(base)}, {"metallicFactor", metallic}, {"roughnessFactor", roughness}};
  };
  const std::vector<json> materials = {
      {{"name", "floor"},
       {"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}, {"extensions", transform}}},
         {"metallicFactor", 0},
         {"roughnessFactor", 0.4}}}},
      {{"name", "gold"}, {"pbrMetallicRoughness", pbr({1, 0.8, 0.3, 1}, 1, 0.25)}},
      {{"name", "plastic"}, {"pbrMetallicRoughness", pbr({0.8, 0.05, 0.05, 1}, 0, 0.3)}},
      {{"name", "glass"},
       {"pbrMetallicRoughness", pbr({1, 1, 1, 1}, 0, 0)},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume", {{"thicknessFactor", 1}}},
         {"KHR_materials_ior", {{"ior", 1.5}}}}}},
      {{"name", "lacquer"},
       {"pbrMetallicRoughness", pbr({0.1, 0.2, 0.8, 1}, 1, 0.5)},
       {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}}},
      {{"name", "lamp"},
       {"emissiveFactor", {1, 0.9, 0.8}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 12}}}}}}};
  for (const json& material : materials) file.add("materials", material);
  const std::vector<Point> square = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  file.mesh(square, {0, 1, 2, 0, 2, 3}, 0);
  file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      file.accessor<float>({0, 0, 1, 0, 1, 1, 0, 1}, 2);
  file.mesh(square, {0, 2, 1, 0, 3, 2}, 5);
  file.node({{"mesh", 0}, {"scale", {6, 1, 6}}});
  file.node({{"mesh", 1}, {"translation", {0, 5, 0}}});
  const test::SphereMesh ball = test::sphere_mesh(1, 32, 48);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t mesh = file.mesh(ball.positions, ball.indices, i + 1);
    file.root["meshes"][mesh]["primitives"][0]["attributes"]["NORMAL"] =
        file.accessor(GltfWriter::flat(ball.positions), 3);
    file.node({{"mesh", mesh}, {"translation", {2.4 * static_cast<double>(i) - 3.6, 1, 0}}});
  }
  file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"aspectRatio", 2}, {"znear", 0.1}}}});
  file.node({{"camera", 0}, {"translation", {0, 3.2, 12}}, {"rotation", {-0.1, 0, 0, std::sqrt(0.99)}}});
  file.root["extensionsUsed"] = {"KHR_texture_transform",   "KHR_materials_transmission",
                                 "KHR_materials_volume",    "KHR_materials_ior",
                                 "KHR_materials_clearcoat", "KHR_materials_emissive_strength"};
  return file;
}

TEST(GltfSample, IsReadWhole) {
  const Scene scene(read_gltf(sample()));
  EXPECT_EQ(scene.statistics().triangles, 4u + 4 * 32 * 48 * 2 - 4 * 2 * 48);
  EXPECT_EQ(scene.description().materials.size(), 6u);
  EXPECT_EQ(scene.lights().size(), 1u);  // a lamp of two triangles
}

TEST(GltfSample, KhronosValidatorFindsNoErrorInWhatTheTestsWrite) {
  const test::TemporaryDir dir;
  dir.write("sample.glb", sample().binary());
  dir.write("sample.gltf", sample().text("sample.bin"));
  dir.write("sample.bin", sample().buffer());
  dir.write("least.gltf", one_mesh().text());
  test::ChildProcess validator(
      "/usr/bin/env",
      {"node", LANTHORN_SOURCE_DIR "/tests/support/validate_gltf.js", "sample.glb", "sample.gltf", "least.gltf"},
      dir.path());
  const test::Ending ending = validator.wait();
  // 126: a folder of PATH is not readable.
  if (ending.exit_code == 77 || ending.exit_code == 126 || ending.exit_code == 127)
    GTEST_SKIP() << "NOT VALIDATED: needs node and its package gltf-validator (npm install -g gltf-validator)";
  EXPECT_EQ(ending.exit_code, 0) << ending.out << ending.err;
}

std::string list(const std::vector<float>& numbers) {
  std::string text = "[";
  for (const float x : numbers) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.9g ", static_cast<double>(x));
    text += buffer;
  }
  return text + "]";
}

// The same glass mesh, lights and camera, once in each format.
TEST(GltfRender, GlassSphereIsTheSameAsInPbrtForm) {
  const test::SphereMesh sphere = test::sphere_mesh(1, 24, 32);
  std::string indices = "[";
  for (const std::uint32_t i : sphere.indices) indices += std::to_string(i) + " ";
  const std::vector<float> normals = GltfWriter::flat(sphere.positions);
  const SceneDescription pbrt = read_pbrt_string(
      R"(Scale -1 1 1 LookAt 0 1 5  0 0 0  0 1 0 Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 32 "integer yresolution" 24
WorldBegin
LightSource "infinite" "rgb L" [0.4 0.5 0.6]
AttributeBegin AreaLightSource "diffuse" "rgb L" [8 8 8] Translate 0 4 0 Shape "sphere" "float radius" 0.5 AttributeEnd
Material "dielectric" "float eta" 1.45
Shape "trianglemesh" "point3 P" )" +
          list(GltfWriter::flat(sphere.positions)) + R"( "normal N" )" + list(normals) + R"( "integer indices" )" +
          indices + "]",
      "", "t.pbrt");
  GltfWriter file;
  file.mesh(sphere.positions, sphere.indices,
            file.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                                   {"extensions",
                                    {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                     {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                                     {"KHR_materials_ior", {{"ior", 1.45}}}}}}));
  file.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = file.accessor(normals, 3);
  file.node({{"mesh", 0}});
  SceneDescription gltf = read_gltf(file);
  // Everything except the glass comes from the other file.
  SceneDescription joined = pbrt;
  ASSERT_EQ(joined.shapes.size(), 2u);
  joined.shapes[1] = gltf.shapes.at(0);
  joined.shapes[1].material = static_cast<Index>(joined.materials.size());
  joined.materials.push_back(gltf.materials.at(gltf.shapes[0].material));
  const RenderOptions options = test::options_for("path", 4);
  const Image a = test::render_image(Scene(pbrt), options), b = test::render_image(Scene(joined), options);
  EXPECT_EQ(a.pixels, b.pixels);
}

}  // namespace
}  // namespace lanthorn::gltf_sample_test
