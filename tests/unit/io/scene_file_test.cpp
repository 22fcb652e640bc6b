// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A scene file that is read once for several times of its animation.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/image_file.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "support/gltf_writer.h"
#include "support/temporary_dir.h"

namespace lanthorn::scene_file_test {
namespace {

using test::GltfWriter;

Image checks(float bright) {
  Image image(4, 4, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = i / 3 % 3 == 0 ? bright : 0.1f;
  return image;
}

// Two squares: one has a picture beside the file, one a picture inside it. The second moves.
class SceneFiles : public testing::Test {
 protected:
  SceneFiles() {
    write_image(dir_.path() / "beside.png", checks(0.9f));
    write_image(dir_.path() / "inside.png", checks(0.5f));
    write_exr(dir_.path() / "sky.exr", [] {
      Image image(8, 4, {"R", "G", "B"});
      for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i % 11);
      return image;
    }());
    GltfWriter file;
    file.add("images", {{"uri", "beside.png"}});
    file.add("images", {{"bufferView", file.view(read_file(dir_.path() / "inside.png"))}, {"mimeType", "image/png"}});
    for (const int i : {0, 1}) {
      file.add("textures", {{"source", i}});
      file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}, {"metallicFactor", 0}}}});
      const std::size_t mesh =
          file.mesh({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {0, 1, 2, 0, 2, 3}, static_cast<std::size_t>(i));
      file.root["meshes"][mesh]["primitives"][0]["attributes"]["TEXCOORD_0"] =
          file.accessor<float>({0, 0, 1, 0, 1, 1, 0, 1}, 2);
      file.node({{"mesh", mesh}, {"translation", {2 * i, 0, 0}}});
    }
    const nlohmann::json sampler = {{"input", file.accessor<float>({0, 2}, 1)},
                                    {"output", file.accessor<float>({2, 0, 0, 2, 4, 0}, 3)}};
    file.add("animations", {{"samplers", {sampler}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
    dir_.write("moves.bin", file.buffer());
    dir_.write("moves.gltf", file.text("moves.bin"));
  }
  ReadOptions options() const {
    ReadOptions options;
    options.environment = {.source = (dir_.path() / "sky.exr").string(), .rotation = 30};
    return options;
  }
  std::filesystem::path path() const { return dir_.path() / "moves.gltf"; }
  static std::vector<float> picture(const SharedScene& scene) {
    RenderOptions options;
    options.integrator = "path";
    options.passes = 2;
    options.resolution = {16, 12};
    Session session(scene, options);
    session.render();
    return session.picture().pixels;
  }

  test::TemporaryDir dir_;
};

TEST_F(SceneFiles, MomentsAreThoseOfReadingAnew) {
  SceneFile file(path(), options());
  SharedScene last;
  for (const double seconds : {0.0, 1.0, 0.5}) {
    ReadOptions at = options();
    at.at = seconds;
    SceneDescription anew = read_scene(path(), at), moment = file.at(seconds);
    EXPECT_EQ(moment.hash, anew.hash);
    EXPECT_EQ(moment.embedded_images.size(), 1u);
    ASSERT_EQ(moment.files.size(), anew.files.size());
    for (const auto& [name, known] : anew.files) EXPECT_EQ(moment.files.at(name).hash, known.hash) << name;
    ASSERT_EQ(moment.warnings.size(), anew.warnings.size());
    last = build_scene(std::move(moment), last);
    EXPECT_EQ(picture(last), picture(build_scene(std::move(anew)))) << seconds;
  }
}

TEST_F(SceneFiles, NothingIsReadAgain) {
  SceneFile file(path(), options());
  SharedScene scene = build_scene(file.at(0));
  const std::vector<float> first = picture(scene);
  for (const char* name : {"moves.gltf", "moves.bin", "beside.png", "sky.exr"})
    std::filesystem::remove(dir_.path() / name);
  EXPECT_NE(picture(scene = build_scene(file.at(1), scene)), first);
  // Data that scenes share outlive the scene that they come from.
  EXPECT_EQ(picture(scene = build_scene(file.at(0), scene)), first);
  EXPECT_EQ(picture(build_scene(description_of(*scene), scene)), first);
  EXPECT_THROW(build_scene(file.at(1)), Error) << "without another scene, its images are read";
}

// Deformed meshes are read before the others; at rest, the other mesh comes first.
TEST_F(SceneFiles, PicturesInTheFileKeepTheirMeshes) {
  GltfWriter model;
  for (const int i : {0, 1}) {
    const std::string bytes = read_file(dir_.path() / (i == 0 ? "inside.png" : "beside.png"));
    model.add("images", {{"bufferView", model.view(bytes)}, {"mimeType", "image/png"}});
    model.add("textures", {{"source", i}});
    model.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}, {"metallicFactor", 0}}}});
    model.mesh({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {0, 1, 2}, static_cast<std::size_t>(i));
    model.root["meshes"][i]["primitives"][0]["attributes"]["TEXCOORD_0"] = model.accessor<float>({0, 0, 1, 0, 1, 1}, 2);
  }
  model.root["meshes"][1]["primitives"][0]["targets"] = {
      {{"POSITION", model.positions({{0, 1, 0}, {0, 0, 0}, {0, 0, 0}})}}};
  model.node({{"mesh", 1}, {"translation", {2, 0, 0}}});
  model.node({{"mesh", 0}});
  const nlohmann::json sampler = {{"input", model.accessor<float>({0, 1}, 1)},
                                  {"output", model.accessor<float>({0, 1}, 1)}};
  model.add("animations", {{"samplers", {sampler}},
                           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
  const std::filesystem::path path = dir_.write("morphs.glb", model.binary());
  SceneFile file(path);
  const SharedScene rest = build_scene(file.at(0));
  ReadOptions options;
  options.at = 1;
  EXPECT_EQ(picture(build_scene(file.at(1), rest)), picture(build_scene(read_scene(path, options))));
}

TEST_F(SceneFiles, OfOtherFormatsStandStill) {
  dir_.write("still.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  SceneFile file(dir_.path() / "still.obj");
  EXPECT_EQ(file.at({}).shapes.size(), 1u);
  EXPECT_EQ(file.at({}).shapes.size(), 1u);
  EXPECT_THROW(file.at(1), Error);
}

}  // namespace
}  // namespace lanthorn::scene_file_test
