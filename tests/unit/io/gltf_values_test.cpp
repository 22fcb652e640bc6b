// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Values that glTF forbids, but that other programs write and read. Each is replaced, with one warning.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/gltf_triangle.h"
#include "support/read_gltf.h"

namespace lanthorn::gltf_values_test {
namespace {

using namespace description;
using nlohmann::json;
using test::corners;
using test::gltf_error;
using test::GltfWriter;
using test::one_mesh;
using test::read_gltf;

// Warnings without those of the stand-ins.
std::vector<std::string> warnings(const SceneDescription& scene) {
  std::vector<std::string> all = test::warnings(scene);
  std::erase_if(all, [](const std::string& text) { return text.find(" stands in") != text.npos; });
  return all;
}

SceneDescription with_material(json material) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2}, file.add("materials", std::move(material)));
  file.node({{"mesh", 0}});
  return read_gltf(file);
}
template <class T>
const T& node_of(const SceneDescription& scene) {
  return std::get<T>(scene.materials.at(scene.shapes.at(0).material).node);
}

using Texts = std::vector<std::string>;

TEST(GltfValues, IndicesOfRefraction) {
  const auto with = [](double ior) {
    return with_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}, {"extensions", {{"KHR_materials_ior", {{"ior", ior}}}}}});
  };
  const SceneDescription scene = with(0.99999);
  EXPECT_EQ(std::get<float>(node_of<PlasticMaterial>(scene).eta), 1);
  EXPECT_EQ(warnings(scene), Texts{"t.gltf#/materials/0/extensions/KHR_materials_ior/ior: ior must be at least 1, but "
                                   "is 0.99999: 1 is used"});
  for (const double valid : {0.0, 1.0, 2.4}) EXPECT_EQ(warnings(with(valid)), Texts{}) << valid;
}

TEST(GltfValues, AttenuationWithoutADistance) {
  const auto with = [](const json& distance) {
    return with_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
         {"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 1}, {"attenuationDistance", distance}, {"attenuationColor", {0.5, 0.5, 0.5}}}}}}});
  };
  const std::string place = "t.gltf#/materials/0/extensions/KHR_materials_volume/attenuationDistance: ";
  const SceneDescription zero = with(0), null = with(nullptr);
  EXPECT_FALSE(zero.shapes.at(0).inside_medium || null.shapes.at(0).inside_medium);
  EXPECT_EQ(warnings(zero), Texts{place + "attenuationDistance must be above 0, but is 0: ignored"});
  EXPECT_EQ(warnings(null), Texts{place + "attenuationDistance is null: read as if it were missing"});
  EXPECT_TRUE(with(2).shapes.at(0).inside_medium);
}

TEST(GltfValues, ColoursOfThreeAndFourNumbers) {
  const SceneDescription scene =
      with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3}}, {"metallicFactor", 0}}},
                     {"emissiveFactor", {3, -1, 2, 1}},
                     {"alphaMode", "BLEND"}});
  const auto& reflectance = node_of<PlasticMaterial>(scene).reflectance;
  EXPECT_EQ(std::get<RgbSpectrum>(reflectance.value).rgb, (Rgb{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(scene.shapes.at(0).alpha.value, 1);
  EXPECT_EQ(std::get<RgbSpectrum>(scene.area_lights.at(0).radiance.value).rgb, (Rgb{3, 0, 2}));
  EXPECT_EQ(
      warnings(scene),
      (Texts{"t.gltf#/materials/0/pbrMetallicRoughness/baseColorFactor: baseColorFactor needs 4 numbers, has 3: "
             "defaults are used for the rest",
             "t.gltf#/materials/0/emissiveFactor: emissiveFactor needs 3 numbers, has 4: the rest are ignored (and 1 "
             "more like it)"}));
}

TEST(GltfValues, FactorsAndNames) {
  const SceneDescription scene =
      with_material({{"name", nullptr},
                     {"alphaMode", "blend"},
                     {"pbrMetallicRoughness",
                      {{"baseColorFactor", {1, 1, 1, 0.25}}, {"metallicFactor", 1.5}, {"roughnessFactor", "rough"}}}});
  EXPECT_EQ(node_of<ConductorMaterial>(scene).roughness.u.value, 1);
  EXPECT_EQ(scene.shapes.at(0).alpha.value, 0.25f);
  EXPECT_EQ(warnings(scene),
            (Texts{"t.gltf#/materials/0/pbrMetallicRoughness/metallicFactor: metallicFactor must be between 0 and 1, "
                   "but is 1.5: 1 is used",
                   "t.gltf#/materials/0/pbrMetallicRoughness/roughnessFactor: roughnessFactor must be between 0 and 1, "
                   "but is string: 1 is used",
                   "t.gltf#/materials/0/name: name is null: read as if it were missing",
                   R"(t.gltf#/materials/0/alphaMode: BLEND is not written "blend": read as BLEND)"}));
  EXPECT_EQ(with_material({{"alphaMode", "GLASS"}}).shapes.at(0).alpha.value, 1);
}

// Many materials with the same fault take one line.
TEST(GltfValues, AreCountedByKind) {
  GltfWriter file;
  for (int i = 0; i < 3; ++i) {
    const json pbr = {{"metallicFactor", 2 + i}};
    file.mesh(corners, {0, 1, 2}, file.add("materials", {{"pbrMetallicRoughness", pbr}}));
    file.node({{"mesh", i}});
  }
  EXPECT_EQ(
      warnings(read_gltf(file)),
      Texts{"t.gltf#/materials/0/pbrMetallicRoughness/metallicFactor: metallicFactor must be between 0 and 1, but "
            "is 2: 1 is used (and 2 more like it)"});
}

TEST(GltfValues, FilmsThatAreAbsentMayBeWrong) {
  const auto with = [](double factor) {
    return with_material(
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
         {"extensions", {{"KHR_materials_iridescence", {{"iridescenceFactor", factor}, {"iridescenceIor", 0.5}}}}}});
  };
  EXPECT_EQ(warnings(with(0)), Texts{});
  const SceneDescription filmed = with(1);
  EXPECT_EQ(node_of<PlasticMaterial>(filmed).film.value().eta, 1);
  EXPECT_EQ(warnings(filmed).size(), 1u);
}

// A file with one light; returns its description.
SceneDescription with_light(const json& light, json node = json::object()) {
  GltfWriter file = one_mesh();
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({light});
  node["extensions"]["KHR_lights_punctual"]["light"] = 0;
  file.node(std::move(node));
  return read_gltf(file);
}

TEST(GltfValues, ConesOfSpots) {
  struct Case {
    json inner, outer;
    float cone = 0, edge = 0;  // degrees
    std::size_t warnings = 0;
  };
  const double right = std::acos(0.0);
  for (const auto& [inner, outer, cone, edge, count] :
       {Case{0.5, 0.5, 28.6479f, 0, 0}, Case{0, right, 90, 90, 0}, Case{0, 1.2 * right, 90, 90, 1},
        Case{0.6, 0.5, 28.6479f, 0, 1}, Case{0, 0, 45, 45, 1}, Case{-1, 0.5, 28.6479f, 28.6479f, 1},
        Case{nullptr, nullptr, 45, 45, 1}}) {
    const SceneDescription scene =
        with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}});
    const auto& spot = std::get<description::SpotLight>(scene.lights.at(0).node);
    EXPECT_NEAR(spot.cone_angle, cone, 0.01f) << inner << outer;
    EXPECT_NEAR(spot.cone_delta_angle, edge, 0.01f) << inner << outer;
    EXPECT_EQ(warnings(scene).size(), count) << testing::PrintToString(warnings(scene));
  }
}

TEST(GltfValues, LightsThatCannotShineAreLeftOut) {
  const auto lights = [](const json& light, const json& node = json::object()) {
    const SceneDescription scene = with_light(light, node);
    EXPECT_EQ(warnings(scene).size(), 1u) << testing::PrintToString(warnings(scene));
    return std::count_if(scene.lights.begin(), scene.lights.end(), [](const description::Light& l) {
      return !std::holds_alternative<description::InfiniteLight>(l.node);
    });
  };
  EXPECT_EQ(lights({{"type", "area"}}), 0);
  EXPECT_EQ(lights({{"type", "point"}, {"intensity", -1}}), 0);
  EXPECT_EQ(lights({{"type", "point"}}, {{"scale", {0, 0, 0}}}), 0);
  EXPECT_EQ(lights({{"type", "Point"}}), 1);
  EXPECT_EQ(lights({{"type", "point"}, {"color", {1, 1, 1, 1}}}), 1);
}

TEST(GltfValues, CamerasAndMatrices) {
  GltfWriter file = one_mesh();
  json matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0.9999999};
  file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}, {"aspectRatio", 0}}}});
  file.node({{"camera", 0}, {"matrix", matrix}});
  const SceneDescription scene = read_gltf(file);
  EXPECT_EQ(scene.view.camera.camera_to_world.start.point(Point(0)), Point(0, 0, 2));
  EXPECT_EQ(scene.view.film.width, 1280);
  EXPECT_EQ(scene.view.film.height, SceneDescription().view.film.height);
  EXPECT_EQ(warnings(scene),
            (Texts{"t.gltf#/nodes/1/matrix: the matrix must be affine, but its last row is 0 0 0 0.9999999: 0 0 0 1 is "
                   "used",
                   "t.gltf#/cameras/0/perspective/aspectRatio: aspectRatio must be above 0.001 and below 1000, but is "
                   "0: 1.7777778 is used"}));
}

TEST(GltfValues, TexturesOfAnUnknownKind) {
  GltfWriter file;
  file.add("images", {{"uri", "a.png"}});
  file.add("samplers", {{"wrapS", 7}});
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  const json transform = {{"offset", {0.5}}, {"scale", nullptr}};
  file.mesh(
      corners, {0, 1, 2},
      file.add("materials",
               {{"pbrMetallicRoughness",
                 {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}}));
  file.node({{"mesh", 0}});
  const SceneDescription scene = read_gltf(file);
  const auto& image = std::get<ImageTexture>(scene.spectrum_textures.at(0).node);
  EXPECT_EQ(image.wrap, Wrap::repeat);
  EXPECT_EQ(std::get<UvMapping>(image.mapping).offset, Vec2(0.5f, 0));
  EXPECT_EQ(warnings(scene).size(), 3u) << testing::PrintToString(warnings(scene));
}

// Structure is not guessed.
TEST(GltfValues, BadReferencesStayErrors) {
  GltfWriter file = one_mesh();
  file.root["materials"] = json::array();
  file.root["meshes"][0]["primitives"][0]["material"] = 3;
  EXPECT_NE(gltf_error(file), "");
  GltfWriter camera = one_mesh();
  camera.add("cameras", {{"type", "fisheye"}});
  camera.node({{"camera", 0}});
  EXPECT_EQ(gltf_error(camera), R"(t.gltf#/cameras/0/type: must be perspective or orthographic, not "fisheye")");
}

TEST(GltfExtensions, ThatAreUnknownAreListedInOneLine) {
  GltfWriter file = one_mesh();
  file.root["extensionsUsed"] = {"A_one", "KHR_materials_ior", "B_two", "C_three"};
  EXPECT_EQ(warnings(read_gltf(file)),
            Texts{R"(t.gltf#/extensionsUsed/0: extensions "A_one", "B_two", "C_three" are not supported: ignored)"});
}

// KHR_materials_variants: two meshes, of which the first has other materials in the variants "night" and "blue".
class GltfVariants : public ::testing::Test {
 protected:
  GltfVariants() {
    for (const char* name : {"own", "dark", "sea"}) file_.add("materials", {{"name", name}});
    for (int i = 0; i < 2; ++i) {
      file_.mesh(corners, {0, 1, 2}, 0);
      file_.node({{"mesh", i}});
    }
    const json variants = json::array({{{"name", "day"}}, {{"name", "night"}}, {{"name", "blue"}}});
    file_.root["extensions"]["KHR_materials_variants"]["variants"] = variants;
    file_.root["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] =
        json::array({{{"material", 1}, {"variants", {1}}}, {{"material", 2}, {"variants", {0, 2}}}});
  }
  SceneDescription read(const std::string& variant) const {
    return with_stand_ins(gltf::read(file_.text(), "", "t.gltf", test::no_files, {{}, "", variant}));
  }
  Texts materials(const std::string& variant) const {
    const SceneDescription scene = read(variant);
    Texts names;
    for (const Shape& shape : scene.shapes) names.push_back(scene.materials.at(shape.material).name);
    return names;
  }
  GltfWriter file_;
};

TEST_F(GltfVariants, AreChosenByNameOrNumber) {
  EXPECT_EQ(materials(""), (Texts{"own", "own"}));
  EXPECT_EQ(materials("night"), (Texts{"dark", "own"}));
  EXPECT_EQ(materials("blue"), (Texts{"sea", "own"}));
  EXPECT_EQ(materials("2"), (Texts{"dark", "own"}));
  EXPECT_EQ(warnings(read("blue")), Texts{});
  EXPECT_EQ(warnings(read("")), Texts{"t.gltf#/extensions/KHR_materials_variants: the file has variants of its "
                                      R"(materials: --variant takes one of "day", "night", "blue")"});
}

TEST_F(GltfVariants, UnknownOnesAreAnswered) {
  const auto error = [&](const std::string& wanted) { return test::error_text([&] { read(wanted); }); };
  EXPECT_EQ(error("nigth"), R"(t.gltf: --variant nigth: the file has "day", "night", "blue"; did you mean night?)");
  EXPECT_EQ(error("4").substr(0, 31), "t.gltf: --variant 4: the file h");
  file_ = one_mesh();
  EXPECT_EQ(error("red"), "t.gltf: --variant red: the file has no variants of its materials");
}

// Whether a material under a single lamp gets the dim studio.
TEST(GltfLights, AreHelpedWhereMetalOrGlassReflectsDarkness) {
  const auto is_helped = [](json material, const char* light = "directional") {
    GltfWriter file;
    file.mesh(corners, {0, 1, 2}, file.add("materials", std::move(material)));
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({{{"type", light}}});
    file.node({{"mesh", 0}});
    file.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {0, 0, 5}}});
    return read_gltf(file).lights.size() == 2;
  };
  const auto metal = [](float roughness) { return json{{"pbrMetallicRoughness", {{"roughnessFactor", roughness}}}}; };
  json matte{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.1}}}};
  EXPECT_TRUE(is_helped(metal(0.2f)));
  EXPECT_TRUE(is_helped(metal(0.2f), "point"));
  EXPECT_FALSE(is_helped(metal(1)));
  EXPECT_FALSE(is_helped(matte));
  matte["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  EXPECT_TRUE(is_helped(matte));
}

}  // namespace
}  // namespace lanthorn::gltf_values_test
