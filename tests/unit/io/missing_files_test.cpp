// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes with missing files, in every format: all missing files are named at once, or skipped.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "camera/lens_system.h"
#include "lanthorn/scene.h"
#include "support/error_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::missing_files_test {
namespace {

class MissingFiles : public testing::Test {
 protected:
  std::string error_of(const std::string& scene) {
    return test::error_text([&] { read_scene(dir_.path() / scene); });
  }
  SceneDescription read_without(const std::string& scene) {
    ReadOptions options;
    options.skip_missing = true;
    return read_scene(dir_.path() / scene, options);
  }
  std::string place(const std::string& text) const { return (dir_.path() / text).string(); }

  test::TemporaryDir dir_;
};

std::string all_messages(const SceneDescription& scene) {
  std::string text;
  for (const description::Warning& w : scene.warnings) text += w.message + "\n";
  return text;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

// A single warning names all missing files.
void expect_named(const SceneDescription& scene, const std::vector<std::string>& files) {
  const std::string all = all_messages(scene);
  EXPECT_TRUE(contains(all, files.size() == 1 ? " is missing: " : " files are missing, the first of them here: "))
      << all;
  EXPECT_EQ(all.find(" missing"), all.rfind(" missing")) << all;
  for (const std::string& name : files) EXPECT_TRUE(contains(all, "\"" + name + "\"")) << name << ": " << all;
}

TEST_F(MissingFiles, OfPbrtScenes) {
  dir_.write("a.pbrt",
             R"(WorldBegin
Include "part.pbrt"
LightSource "point" "spectrum I" "lamp.spd"
Material "conductor" "spectrum eta" "eta.spd"
Shape "plymesh" "string filename" "no.ply"
Shape "sphere"
)");
  EXPECT_EQ(error_of("a.pbrt"), place("a.pbrt") +
                                    R"(:2:1: 4 files are missing, the first of them here: "part.pbrt", "lamp.spd", )"
                                    R"("eta.spd", "no.ply"; --missing skip renders without them)");
  const SceneDescription scene = read_without("a.pbrt");
  EXPECT_EQ(scene.shapes.size(), 1u);
  expect_named(scene, {"part.pbrt", "lamp.spd", "eta.spd", "no.ply"});
}

// Without the lens file, brightness, focus and blur stay similar, since another lens is placed behind the same
// aperture.
TEST_F(MissingFiles, LensesMediaAndMeasuredMaterialsHaveStandIns) {
  dir_.write("a.pbrt",
             R"(Camera "realistic" "string lensfile" "no.dat" "float aperturediameter" 5
WorldBegin
MakeNamedMedium "smoke" "string type" "nanovdb" "string filename" "no.nvdb"
MediumInterface "smoke" ""
Material "measured" "string filename" "no.bsdf"
Shape "sphere"
Shape "sphere" "float radius" 2
)");
  EXPECT_EQ(error_of("a.pbrt"), place("a.pbrt") +
                                    R"(:1:1: 3 files are missing, the first of them here: "no.dat", "no.nvdb", )"
                                    R"("no.bsdf"; --missing skip renders without them)");
  const SceneDescription scene = read_without("a.pbrt");
  expect_named(scene, {"no.dat", "no.nvdb", "no.bsdf"});
  EXPECT_TRUE(std::holds_alternative<description::DiffuseMaterial>(scene.materials.back().node));
  const LensSystem lens(std::get<description::RealisticCamera>(scene.view.camera.node), 0.0175, {});
  EXPECT_NEAR(lens.focal_length(), 0.05, 0.0005);
  EXPECT_NO_THROW(build_scene(scene));
}

// A lens of 50 mm cannot focus nearer than four times its focal length.
TEST_F(MissingFiles, TheLensThatStandsInFocusesOnWhatIsClose) {
  dir_.write("a.pbrt", R"(Camera "realistic" "string lensfile" "no.dat" "float focusdistance" .1
WorldBegin
)");
  const SceneDescription scene = read_without("a.pbrt");
  const LensSystem lens(std::get<description::RealisticCamera>(scene.view.camera.node), 0.0175, {});
  EXPECT_NEAR(lens.focal_length(), 0.0125, 0.0002);
}

// Long names that differ at their ends.
TEST_F(MissingFiles, OfLongNamesTheEndIsShown) {
  dir_.write("a.pbrt",
             R"(WorldBegin
Shape "plymesh" "string filename" "a/folder/of/a/long/name/with/meshes/one.ply"
Shape "plymesh" "string filename" "a/folder/of/a/long/name/with/meshes/two.ply"
)");
  EXPECT_TRUE(contains(error_of("a.pbrt"), R"(".../name/with/meshes/one.ply", ".../name/with/meshes/two.ply"; )"))
      << error_of("a.pbrt");
}

// A single missing file causes the specific error of the code that reads it, with its location and advice.
TEST_F(MissingFiles, ASingleOneHasItsOwnError) {
  const std::string skip = ": no such file; --missing skip renders without it";
  dir_.write("a.pbrt", R"(WorldBegin
Material "conductor" "spectrum eta" "eta.spd"
)");
  EXPECT_EQ(error_of("a.pbrt"), place("a.pbrt") +
                                    R"(:2:22: parameter "eta" of Material "conductor" names the spectrum "eta.spd", )"
                                    "which is not built in; " +
                                    place("eta.spd") + skip);
  dir_.write("b.pbrt", R"(WorldBegin
Include "part.pbrt"
)");
  EXPECT_EQ(error_of("b.pbrt"), place("b.pbrt") + ":2:1: " + place("part.pbrt") + skip);
  dir_.write("c.pbrt", R"(WorldBegin
LightSource "infinite" "string filename" "sky.exr"
)");
  EXPECT_EQ(error_of("c.pbrt"), place("c.pbrt") + ":2:1: " + place("sky.exr") + skip);
  dir_.write("d.pbrt", R"(WorldBegin
Shape "plymesh" "string filename" "no.ply"
)");
  EXPECT_EQ(error_of("d.pbrt"), place("d.pbrt") + ":2:1: " + place("no.ply") + skip);
}

// Definitions missing because of a missing file are not the error to report.
TEST_F(MissingFiles, ComeBeforeErrorsThatTheyMayCause) {
  dir_.write("a.pbrt", R"(WorldBegin
Include "materials.pbrt"
NamedMaterial "gold"
Shape "sphere"
)");
  EXPECT_EQ(error_of("a.pbrt"),
            place("a.pbrt") + ":2:1: " + place("materials.pbrt") + ": no such file; --missing skip renders without it");
}

// Clones of a repository contain such files if Git LFS is not installed.
TEST_F(MissingFiles, PointersOfGitLfsAreMissingFiles) {
  const std::string pointer =
      "version https://git-lfs.github.com/spec/v1\n"
      "oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n";
  dir_.write("a.ply", pointer);
  dir_.write("b.ply", pointer);
  const std::string mesh = R"(Shape "plymesh" "string filename" )";
  dir_.write("one.pbrt", "WorldBegin\n" + mesh + R"("a.ply"
)");
  EXPECT_TRUE(
      contains(error_of("one.pbrt"), place("a.ply") + ": only a Git LFS pointer; git lfs pull fetches the file"))
      << error_of("one.pbrt");
  dir_.write("two.pbrt", "WorldBegin\n" + mesh + R"("a.ply"
)" + mesh + R"("b.ply"
)" + mesh + R"("no.ply"
)");
  EXPECT_TRUE(contains(error_of("two.pbrt"), "3 files are missing")) << error_of("two.pbrt");
  EXPECT_TRUE(contains(error_of("two.pbrt"), ", git lfs pull fetches 2 of them")) << error_of("two.pbrt");
  EXPECT_TRUE(contains(all_messages(read_without("two.pbrt")),
                       R"(3 files are missing, the first of them here: "a.ply", "b.ply", "no.ply")"));
}

const char* const gltf = R"({
  "asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"mesh": 1}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]},
             {"primitives": [{"attributes": {"POSITION": 1}}]}],
  "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
  "textures": [{"source": 0}], "images": [{"uri": "no.png"}],
  "buffers": [{"byteLength": 36, "uri": "no.bin"}, {"byteLength": 36, "uri": "triangle.bin"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 1, "byteLength": 36}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}]
})";

TEST_F(MissingFiles, OfGltfScenes) {
  dir_.write("a.gltf", gltf);
  const std::vector<float> points{0, 0, 0, 1, 0, 0, 0, 1, 0};
  dir_.write("triangle.bin", {reinterpret_cast<const char*>(points.data()), points.size() * sizeof(float)});
  const std::string error = error_of("a.gltf");
  EXPECT_TRUE(contains(error, "2 files are missing, the first of them here: ")) << error;
  EXPECT_TRUE(contains(error, R"("no.bin", "no.png")")) << error;
  const SceneDescription scene = read_without("a.gltf");
  EXPECT_EQ(scene.shapes.size(), 1u) << "the mesh of the other buffer";
  expect_named(scene, {"no.bin", "no.png"});
  dir_.write("no.png", "");
  EXPECT_TRUE(
      contains(error_of("a.gltf"), "#/buffers/0/uri: " + place("no.bin") + ": no such file; --missing skip renders"))
      << error_of("a.gltf");
}

// The value that replaces a texture depends on the texture's role.
TEST_F(MissingFiles, TexturesOfGltfHaveTheNeutralValueOfTheirRole) {
  const std::string models = LANTHORN_SOURCE_DIR "/tests/scenes/models/";
  ReadOptions skip;
  skip.skip_missing = true;
  const SceneDescription dark = read_scene(models + "emissive-missing.gltf", skip);
  EXPECT_TRUE(dark.area_lights.empty()) << "does not emit";
  EXPECT_EQ(std::get<description::RgbSpectrum>(
                std::get<description::PlasticMaterial>(dark.materials.at(0).node).reflectance.value)
                .rgb,
            (Rgb{0.4f, 0.05f, 0.05f}));

  const auto material_of = [&](const std::string& material) {
    dir_.write("m.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
      "textures": [{"source": 0}], "images": [{"uri": "lost.png"}], "materials": [)" +
                             material + R"(],
      "buffers": [{"byteLength": 36, "uri": "triangle.bin"}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]})");
    const std::vector<float> points{0, 0, 0, 1, 0, 0, 0, 1, 0};
    dir_.write("triangle.bin", {reinterpret_cast<const char*>(points.data()), points.size() * sizeof(float)});
    return read_without("m.gltf");
  };
  const std::string lost = R"({"index": 0})";
  const SceneDescription plain = material_of(
      R"({"alphaMode": "MASK", "normalTexture": )" + lost + R"(, "pbrMetallicRoughness": {"baseColorTexture": )" +
      lost +
      R"(, "baseColorFactor": [1, 0.5, 0, 1], "metallicFactor": 0, "roughnessFactor": 0.5, "metallicRoughnessTexture": )" +
      lost + R"(}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": )" +
      lost + R"(}, "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": )" + lost + "}}}");
  const description::Material& m = plain.materials.at(plain.shapes.at(0).material);
  const auto& plastic = std::get<description::PlasticMaterial>(m.node);
  EXPECT_FALSE(m.normal_map);
  EXPECT_EQ(std::get<description::RgbSpectrum>(plastic.reflectance.value).rgb, (Rgb{0.5f, 0.25f, 0}));
  EXPECT_EQ(plastic.roughness.u.value, 0.25f) << "the square of what the factor says";
  EXPECT_EQ(plain.shapes.at(0).alpha.value, 1);
  EXPECT_FALSE(plain.shapes.at(0).alpha.texture);
  const SceneDescription metal = material_of(R"({"pbrMetallicRoughness": {"metallicRoughnessTexture": )" + lost + "}}");
  EXPECT_TRUE(
      std::holds_alternative<description::ConductorMaterial>(metal.materials.at(metal.shapes.at(0).material).node));
  EXPECT_NO_THROW(build_scene(plain));
}

TEST_F(MissingFiles, TexturesOfPbrtAndObjHaveTheNeutralValueOfTheirRole) {
  const std::string lost =
      R"(Texture "f" "float" "imagemap" "string filename" "no.png"
Texture "s" "spectrum" "imagemap" "string filename" "no.png"
Texture "f2" "float" "scale" "texture tex" "f" "float scale" 3
Texture "s2" "spectrum" "scale" "texture tex" "s" "float scale" 3
)";
  dir_.write("a.pbrt", "WorldBegin\n" + lost +
                           R"(AreaLightSource "diffuse" "string filename" "no.png"
Material "diffusetransmission" "texture reflectance" "s2" "texture transmittance" "s" "texture displacement" "f"
Shape "sphere" "texture alpha" "f2"
Material "conductor" "texture reflectance" "s" "texture roughness" "f2"
Shape "sphere"
)");
  const SceneDescription scene = read_without("a.pbrt");
  const auto number = [](const description::SpectrumParameter& p) {
    EXPECT_FALSE(p.texture);
    return std::get<float>(p.value);
  };
  EXPECT_EQ(number(scene.area_lights.at(0).radiance), 0);
  const description::Material& leaf = scene.materials.at(scene.shapes.at(0).material);
  EXPECT_FALSE(leaf.displacement);
  const auto& sheet = std::get<description::DiffuseTransmissionMaterial>(leaf.node);
  EXPECT_EQ(number(sheet.reflectance), 0.5f);
  EXPECT_EQ(number(sheet.transmittance), 0);
  EXPECT_EQ(scene.shapes.at(0).alpha.value, 1);
  EXPECT_FALSE(scene.shapes.at(0).alpha.texture);
  const auto& metal = std::get<description::ConductorMaterial>(scene.materials.at(scene.shapes.at(1).material).node);
  EXPECT_EQ(number(*metal.reflectance), 0.5f);
  EXPECT_EQ(metal.roughness.u.value, 0);
  EXPECT_NO_THROW(build_scene(scene));

  dir_.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
  dir_.write("a.mtl", "newmtl m\nmap_Kd no.png\nKd 1 .5 0\nKe 1 1 1\nmap_Ke no.png\nmap_d no.png\nbump no.png\n");
  const SceneDescription model = read_without("a.obj");
  EXPECT_TRUE(model.area_lights.empty());
  EXPECT_EQ(model.shapes.at(0).alpha.value, 1);
  EXPECT_FALSE(model.shapes.at(0).alpha.texture);
  const description::Material& m = model.materials.at(model.shapes.at(0).material);
  EXPECT_FALSE(m.normal_map || m.displacement);
  EXPECT_EQ(std::get<description::RgbSpectrum>(std::get<description::DiffuseMaterial>(m.node).reflectance.value).rgb,
            (Rgb{0.5f, 0.25f, 0}));
}

TEST_F(MissingFiles, OfObjScenes) {
  dir_.write("a.obj", "mtllib a.mtl\nmtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
  dir_.write("a.mtl", "newmtl m\nmap_Kd no.png\nmap_d holes.png\n");
  // Materials and pictures may be missing, since the model has its shape without them.
  for (const bool skips : {false, true}) {
    const SceneDescription scene = skips ? read_without("a.obj") : read_scene(dir_.path() / "a.obj");
    EXPECT_EQ(scene.shapes.size(), 1u);
    EXPECT_TRUE(contains(all_messages(scene), "no.mtl: no such file: its materials are left out"))
        << all_messages(scene);
    EXPECT_TRUE(
        contains(all_messages(scene), R"(2 files are missing, the first of them here: "no.png", "holes.png": )"))
        << all_messages(scene);
    EXPECT_NO_THROW(build_scene(scene));
  }
  // An MTL file may serve several models.
  dir_.write("a.mtl", "newmtl m\nnewmtl other\nmap_Kd no.png\nmap_d holes.png\n");
  EXPECT_TRUE(read_scene(dir_.path() / "a.obj").files.count("no.png") == 0);
}

// Files from systems that ignore case, and with absolute names of other machines.
TEST_F(MissingFiles, AreLookedForByCaseAndByTheirLastPart) {
  std::filesystem::create_directories(dir_.path() / "Textures");
  dir_.write("Textures/wood.png", "");
  dir_.write("Bark.png", "");
  const auto image_of = [&](const std::string& name) {
    dir_.write("a.obj", "mtllib .\\LIB.MTL\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    dir_.write("lib.mtl", "newmtl m\nmap_Kd " + name + "\n");
    return read_without("a.obj");
  };
  for (const auto& [name, found] :
       {std::pair("textures\\Wood.PNG", "Textures/wood.png"), std::pair("C:\\Users\\me\\bark.png", "Bark.png"),
        std::pair("E:/models/ring/textures/wood.png", "Textures/wood.png"),
        std::pair("E:/wood.png", "Textures/wood.png"), std::pair("\\\\server\\share\\Bark.png", "Bark.png"),
        std::pair("..\\..\\maps\\Bark.png", "Bark.png"), std::pair("wood.png", "Textures/wood.png"),
        std::pair("/home/me/Bark.png", "Bark.png")}) {
    const SceneDescription scene = image_of(name);
    ASSERT_EQ(scene.files.size(), 2u) << "the library and the image";
    EXPECT_TRUE(std::any_of(scene.files.begin(), scene.files.end(), [&](const auto& file) {
      return file.second.path.lexically_normal() == dir_.path() / found;
    })) << name;
    EXPECT_TRUE(contains(all_messages(scene), "lib.mtl\" is read")) << all_messages(scene);
  }
  // A relative name may only differ in case: the same name elsewhere is another file.
  EXPECT_TRUE(contains(all_messages(image_of("images/Bark.png")), "is missing"));
  dir_.write("b.pbrt",
             R"(WorldBegin
Texture "t" "spectrum" "imagemap" "string filename" "TEXTURES/wood.png"
)");
  EXPECT_TRUE(contains(all_messages(read_without("b.pbrt")), R"(there is no file "TEXTURES/wood.png": )"));
  dir_.write("b.pbrt",
             R"(WorldBegin
Texture "t" "spectrum" "imagemap" "string filename" "E:\\x\\bark.png"
)");
  EXPECT_TRUE(contains(all_messages(read_without("b.pbrt")), "Bark.png\" is read"));
  // The layout of downloads from Sketchfab.
  dir_.write("source/a.pbrt", R"(WorldBegin
Texture "t" "spectrum" "imagemap" "string filename" "wood.png"
)");
  EXPECT_TRUE(contains(all_messages(read_without("source/a.pbrt")), "wood.png\" is read"));
}

// Nothing outside the sandbox is listed or found.
TEST_F(MissingFiles, AreLookedForInTheSandboxAlone) {
  std::filesystem::create_directories(dir_.path() / "scene");
  dir_.write("Secret.png", "");
  dir_.write("scene/Own.png", "");
  FileAccess access;
  access.sandbox = std::filesystem::canonical(dir_.path() / "scene");
  EXPECT_EQ(access.find(access.sandbox, "own.png"), access.sandbox / "Own.png");
  for (const char* name : {"../secret.png", "../Secret.png", "../scene/../secret.png"})
    EXPECT_EQ(access.find(access.sandbox, name), access.sandbox / name);
}

}  // namespace
}  // namespace lanthorn::missing_files_test
