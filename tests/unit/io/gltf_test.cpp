// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "lanthorn/file.h"
#include "lanthorn/image_file.h"
#include "lanthorn/scene.h"
#include "support/child_process.h"
#include "support/gltf_writer.h"
#include "support/read_gltf.h"
#include "support/render_scene.h"
#include "support/temporary_dir.h"

namespace lanthorn::gltf_test {
namespace {

using namespace description;
using nlohmann::json;
using test::gltf_error;
using test::GltfWriter;
using test::read_gltf;
using test::warnings;

const std::vector<Point> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

const TriangleMesh& mesh_of(const Shape& shape) { return std::get<TriangleMesh>(shape.geometry); }

// A file with one mesh, placed once; `change` may alter its only primitive.
template <class Change>
GltfWriter one_mesh(const Change& change) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2});
  file.node({{"mesh", 0}});
  change(file, file.root["meshes"][0]["primitives"][0]);
  return file;
}
GltfWriter one_mesh() {
  return one_mesh([](auto&, auto&) {});
}

template <class T>
std::vector<Point> positions_of(const std::vector<T>& values, bool normalized, std::size_t padding) {
  const GltfWriter file = one_mesh([&](GltfWriter& writer, json& primitive) {
    primitive["attributes"]["POSITION"] = writer.padded_accessor(values, 3, normalized, padding);
  });
  return mesh_of(read_gltf(file).shapes.at(0)).positions;
}

TEST(GltfAccessor, ComponentTypesAndNormalisation) {
  EXPECT_EQ(positions_of<float>({1, 2.5f, -3, 4, 5, 6, 7, 8, 9}, false, 0),
            (std::vector<Point>{{1, 2.5f, -3}, {4, 5, 6}, {7, 8, 9}}));
  EXPECT_EQ(positions_of<float>({1, 2.5f, -3, 4, 5, 6, 7, 8, 9}, false, 8),
            (std::vector<Point>{{1, 2.5f, -3}, {4, 5, 6}, {7, 8, 9}}));
  EXPECT_EQ(positions_of<std::int8_t>({1, -2, 3, 4, 5, 6, 127, -128, 0}, false, 1),
            (std::vector<Point>{{1, -2, 3}, {4, 5, 6}, {127, -128, 0}}));
  EXPECT_EQ(positions_of<std::int8_t>({0, -127, 127, -128, 0, 0, 0, 0, 0}, true, 1),
            (std::vector<Point>{{0, -1, 1}, {-1, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(positions_of<std::uint8_t>({0, 255, 51, 1, 2, 3, 4, 5, 6}, false, 1),
            (std::vector<Point>{{0, 255, 51}, {1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(positions_of<std::uint8_t>({0, 255, 51, 0, 0, 0, 0, 0, 0}, true, 1),
            (std::vector<Point>{{0, 1, 0.2f}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(positions_of<std::int16_t>({300, -300, 1, 0, 0, 0, 0, 0, 0}, false, 2),
            (std::vector<Point>{{300, -300, 1}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(positions_of<std::int16_t>({32767, -32767, -32768, 0, 0, 0, 0, 0, 0}, true, 2),
            (std::vector<Point>{{1, -1, -1}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(positions_of<std::uint16_t>({65535, 13107, 0, 0, 0, 0, 0, 0, 0}, true, 2),
            (std::vector<Point>{{1, 0.2f, 0}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(positions_of<std::uint32_t>({70000, 1, 2, 0, 0, 0, 0, 0, 0}, false, 0),
            (std::vector<Point>{{70000, 1, 2}, {0, 0, 0}, {0, 0, 0}}));
}

TEST(GltfAccessor, IndicesOfEveryType) {
  const auto triangles = [](auto type) {
    using T = decltype(type);
    return mesh_of(read_gltf(one_mesh([](GltfWriter& file, json& primitive) {
                     primitive["indices"] = file.accessor(std::vector<T>{2, 1, 0, 0, 1, 2}, 1);
                   })).shapes.at(0))
        .triangles;
  };
  const std::vector<std::array<std::uint32_t, 3>> expected = {{2, 1, 0}, {0, 1, 2}};
  EXPECT_EQ(triangles(std::uint8_t{}), expected);
  EXPECT_EQ(triangles(std::uint16_t{}), expected);
  EXPECT_EQ(triangles(std::uint32_t{}), expected);
}

TEST(GltfAccessor, SparseReplacesElements) {
  const auto with_base = [](bool base) {
    const GltfWriter file = one_mesh([&](GltfWriter& writer, json& primitive) {
      json accessor = GltfWriter::description<float>(
          base ? std::optional(writer.view(test::bytes_of(GltfWriter::flat(corners)))) : std::nullopt, 3, 3, false);
      accessor["sparse"] = {
          {"count", 2},
          {"indices", {{"bufferView", writer.view(test::bytes_of<std::uint16_t>({0, 2}))}, {"componentType", 5123}}},
          {"values", {{"bufferView", writer.view(test::bytes_of<float>({7, 8, 9, 4, 5, 6}))}}}};
      primitive["attributes"]["POSITION"] = writer.add("accessors", accessor);
    });
    return mesh_of(read_gltf(file).shapes.at(0)).positions;
  };
  EXPECT_EQ(with_base(true), (std::vector<Point>{{7, 8, 9}, {1, 0, 0}, {4, 5, 6}}));
  EXPECT_EQ(with_base(false), (std::vector<Point>{{7, 8, 9}, {0, 0, 0}, {4, 5, 6}}));
}

TEST(GltfMesh, AttributesAndModes) {
  const GltfWriter file = one_mesh([](GltfWriter& writer, json& primitive) {
    primitive["attributes"]["NORMAL"] = writer.accessor<float>({0, 0, 1, 0, 1, 0, 1, 0, 0}, 3);
    primitive["attributes"]["TANGENT"] = writer.accessor<float>({1, 0, 0, 1, 0, 0, 1, 1, 0, 1, 0, -1}, 4);
    primitive["attributes"]["TEXCOORD_0"] = writer.accessor<std::uint8_t>({0, 255, 255, 0, 51, 102}, 2, true);
  });
  const SceneDescription scene = read_gltf(file);
  const TriangleMesh& mesh = mesh_of(scene.shapes.at(0));
  EXPECT_EQ(mesh.normals, (std::vector<Normal>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
  EXPECT_EQ(mesh.tangents, (std::vector<Vec3>{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(mesh.uvs, (std::vector<Vec2>{{0, 0}, {1, 1}, {0.2f, 0.6f}}));  // turned round: t runs upwards

  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  const auto triangles = [](int mode, bool indexed) {
    GltfWriter writer;
    writer.mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}}, {4, 3, 2, 1, 0});
    json& primitive = writer.root["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    if (!indexed) primitive.erase("indices");
    writer.node({{"mesh", 0}});
    const SceneDescription result = read_gltf(writer);
    return result.shapes.empty() ? Triangles() : mesh_of(result.shapes[0]).triangles;
  };
  EXPECT_EQ(triangles(4, false), (Triangles{{0, 1, 2}}));
  EXPECT_EQ(triangles(5, false), (Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(triangles(5, true), (Triangles{{4, 3, 2}, {3, 1, 2}, {2, 1, 0}}));
  EXPECT_EQ(triangles(6, false), (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
}

TEST(GltfMesh, OnlyUsedVerticesAreKept) {
  GltfWriter file;
  std::vector<Point> many(100);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = {static_cast<float>(i), static_cast<float>(i * i), 0};
  file.mesh(many, {90, 5, 40});
  file.node({{"mesh", 0}});
  const TriangleMesh mesh = mesh_of(read_gltf(file).shapes.at(0));
  EXPECT_EQ(mesh.positions, (std::vector<Point>{many[5], many[40], many[90]}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{2, 0, 1}}));
}

TEST(GltfContainer, TextBinaryAndFilesBesideAreTheSame) {
  const test::TemporaryDir dir;
  const GltfWriter file = one_mesh();
  dir.write("a b.bin", file.buffer());
  const auto path = [&](const std::string& name, const std::string& bytes) { return dir.write(name, bytes); };
  for (const auto& scene :
       {read_scene(path("data.gltf", file.text())), read_scene(path("binary.glb", file.binary())),
        read_scene(path("binary.gltf", file.binary())), read_scene(path("beside.gltf", file.text("a%20b.bin")))}) {
    ASSERT_EQ(scene.shapes.size(), 1u);
    EXPECT_EQ(mesh_of(scene.shapes[0]).positions, corners);
    EXPECT_NE(scene.hash, 0u);
  }
  EXPECT_EQ(read_scene(dir.path() / "beside.gltf").files.count("a%20b.bin"), 1u);
}

// Models come from the web with the escapes of their URIs as parts of file names.
TEST(GltfContainer, NamesOfFilesMayBeEscapedThemselves) {
  const test::TemporaryDir dir;
  const GltfWriter file = one_mesh();
  dir.write("a%20b.bin", file.buffer());
  const auto scene = dir.write("a.gltf", file.text("a%20b.bin"));
  EXPECT_EQ(mesh_of(read_scene(scene).shapes.at(0)).positions, corners);
  dir.write("a b.bin", "too short");  // the specification's name comes first
  EXPECT_THROW(read_scene(scene), Error);
}

TEST(GltfNodes, TransformsAndInstances) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2});
  file.mesh(corners, {0, 1, 2});
  const std::size_t child = file.add("nodes", {{"mesh", 0}, {"scale", {2, 2, 2}}});
  const double h = std::sqrt(0.5);
  file.node({{"translation", {1, 2, 3}}, {"rotation", {0, 0, h, h}}, {"children", {child}}});
  file.node({{"mesh", 1}});
  file.node({{"mesh", 1}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
  const SceneDescription scene = read_gltf(file);
  ASSERT_EQ(scene.shapes.size(), 1u);
  // Scaled, turned by 90 degrees about z, moved.
  const Point moved = scene.shapes[0].object_to_world.start.point({1, 0, 0});
  EXPECT_NEAR(moved.x, 1, 1e-6f);
  EXPECT_NEAR(moved.y, 4, 1e-6f);
  EXPECT_NEAR(moved.z, 3, 1e-6f);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].shapes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].object_to_world.start.point({1, 2, 3}), Point(1, 2, 3));
  EXPECT_EQ(scene.instances[1].object_to_world.start.point({1, 0, 0}), Point(5, 7, 7));
}

TEST(GltfNodes, GpuInstancing) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2});
  const json attributes = {{"TRANSLATION", file.accessor<float>({0, 0, 0, 5, 0, 0, 0, 6, 0}, 3)},
                           {"SCALE", file.accessor<float>({1, 1, 1, 2, 2, 2, 1, 0, 1}, 3)}};
  file.node({{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
  const SceneDescription scene = read_gltf(file);
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.instances[1].object_to_world.start.point({1, 0, 0}), Point(7, 0, 0));
  const Scene built(scene);
  ASSERT_FALSE(built.warnings().empty());
  EXPECT_EQ(built.warnings().back().message.substr(0, 34), "a shape or instance is left out: t");
  EXPECT_NE(built.warnings().back().location.file.find("#/meshes/0"), std::string::npos);
}

TEST(GltfNodes, EmissiveMeshesAreLampsInEveryNode) {
  GltfWriter file;
  const json strength = {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}};
  file.mesh(corners, {0, 1, 2}, file.add("materials", {{"emissiveFactor", {1, 0.5, 0}}, {"extensions", strength}}));
  file.mesh(corners, {0, 1, 2});
  file.node({{"mesh", 0}});
  file.node({{"mesh", 0}, {"translation", {1, 0, 0}}});
  file.node({{"mesh", 1}});
  const SceneDescription scene = read_gltf(file);
  EXPECT_TRUE(scene.lights.empty());  // no stand-in: the file has a light of its own
  EXPECT_EQ(Scene(scene).lights().size(), 2u);
}

// The materials of a file with this one.
SceneDescription with_material(json material, GltfWriter file = {}) {
  file.mesh(corners, {0, 1, 2}, file.add("materials", std::move(material)));
  file.node({{"mesh", 0}});
  return read_gltf(file);
}
template <class T>
T only_material(json material) {
  const SceneDescription scene = with_material(std::move(material));
  return std::get<T>(scene.materials.at(scene.shapes.at(0).material).node);
}
Rgb rgb(const SpectrumParameter& p) { return std::get<RgbSpectrum>(p.value).rgb; }

TEST(GltfMaterial, MetallicRoughness) {
  const auto plastic = only_material<PlasticMaterial>(
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
       {"extensions", {{"KHR_materials_ior", {{"ior", 1.7}}}, {"KHR_materials_specular", {{"specularFactor", 0.5}}}}}});
  EXPECT_EQ(rgb(plastic.reflectance), (Rgb{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(plastic.roughness.u.value, 0.25f);
  EXPECT_FALSE(plastic.roughness.remap);
  EXPECT_EQ(std::get<float>(plastic.eta), 1.7f);
  EXPECT_EQ(plastic.specular.value, 0.5f);
  const auto metal = only_material<ConductorMaterial>({{"pbrMetallicRoughness", {{"roughnessFactor", 0.1}}}});
  EXPECT_EQ(rgb(*metal.reflectance), (Rgb{1, 1, 1}));
  EXPECT_FLOAT_EQ(metal.roughness.v.value, 0.01f);
  const SceneDescription mixed =
      with_material({{"name", "alloy"}, {"pbrMetallicRoughness", {{"metallicFactor", 0.25}}}});
  ASSERT_EQ(mixed.materials.size(), 3u);
  EXPECT_EQ(mixed.materials[2].name, "alloy");
  const auto& mix = std::get<MixMaterial>(mixed.materials[2].node);
  EXPECT_EQ(mix.amount.value, 0.25f);
  EXPECT_TRUE(std::holds_alternative<PlasticMaterial>(mixed.materials[mix.materials[0]].node));
  EXPECT_TRUE(std::holds_alternative<ConductorMaterial>(mixed.materials[mix.materials[1]].node));
  // Without a material: glTF's default is white rough metal.
  EXPECT_TRUE(std::holds_alternative<ConductorMaterial>(read_gltf(one_mesh()).materials.at(0).node));
}

TEST(GltfMaterial, GlassAndCoats) {
  const json clear = {{"transmissionFactor", 1}};
  const json dielectric = {{"metallicFactor", 0}, {"roughnessFactor", 0}};
  const auto glass = only_material<DielectricMaterial>({{"pbrMetallicRoughness", dielectric},
                                                        {"extensions",
                                                         {{"KHR_materials_transmission", clear},
                                                          {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                                                          {"KHR_materials_ior", {{"ior", 1.33}}}}}});
  EXPECT_EQ(std::get<float>(glass.eta), 1.33f);
  only_material<ThinDielectricMaterial>(
      {{"pbrMetallicRoughness", dielectric}, {"extensions", {{"KHR_materials_transmission", clear}}}});
  const auto prism = only_material<DielectricMaterial>({{"pbrMetallicRoughness", dielectric},
                                                        {"extensions",
                                                         {{"KHR_materials_transmission", clear},
                                                          {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                                                          {"KHR_materials_ior", {{"ior", 1.6}}},
                                                          {"KHR_materials_dispersion", {{"dispersion", 0.5}}}}}});
  const auto& eta = std::get<SampledSpectrum>(prism.eta);
  const auto at = [&](float nm) {
    const auto i = static_cast<std::size_t>((nm - eta.nm[0]) / 5);
    return lerp((nm - eta.nm[i]) / 5, eta.values[i], eta.values[i + 1]);
  };
  EXPECT_NEAR(at(587.6f), 1.6f, 1e-4f);
  EXPECT_NEAR((at(587.6f) - 1) / (at(486.1f) - at(656.3f)), 40, 0.1f);  // Abbe's number: 20 / 0.5
  const auto lacquered = only_material<CoatedConductorMaterial>(
      {{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.5}}}}}});
  EXPECT_EQ(lacquered.coat.roughness.u.value, 0.25f);
  const auto glazed = only_material<CoatedPlasticMaterial>(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
       {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}, {"KHR_materials_ior", {{"ior", 1.6}}}}}});
  EXPECT_EQ(glazed.base.roughness.u.value, 0.25f);
  EXPECT_EQ(std::get<float>(glazed.base.eta), 1.6f);
}

TEST(GltfMaterial, AttenuationIsAMediumInside) {
  const SceneDescription scene = with_material(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {1, 0.5, 0.25}}}}}}});
  const description::Medium& medium = scene.media.at(scene.shapes.at(0).inside_medium.value());
  const Rgb sigma = std::get<RgbSpectrum>(medium.sigma_a).rgb;
  EXPECT_EQ(sigma.r, 0);
  EXPECT_NEAR(std::exp(-0.5f * sigma.g), 0.5f, 1e-6f);
  EXPECT_NEAR(std::exp(-0.5f * sigma.b), 0.25f, 1e-6f);
}

TEST(GltfMaterial, TexturesKeepTheirChannels) {
  GltfWriter file;
  file.add("images", {{"bufferView", file.view("PNG or so")}, {"mimeType", "image/png"}});
  file.add("images", {{"uri", "data:image/png;base64,QUJD"}});
  file.add("images", {{"uri", "wood%20grain.png"}});
  file.add("samplers", {{"wrapS", 33648}, {"wrapT", 33648}, {"magFilter", 9728}});
  for (const int image : {0, 1, 2}) file.add("textures", {{"source", image}});
  file.root["textures"][0]["sampler"] = 0;
  const SceneDescription scene = with_material(
      {{"normalTexture", {{"index", 1}, {"scale", 0.5}}},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 0.25, 1, 0.75}},
         {"baseColorTexture", {{"index", 0}, {"texCoord", 0}}},
         {"metallicFactor", 0.5},
         {"metallicRoughnessTexture", {{"index", 1}}}}},
       {"alphaMode", "MASK"},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionTexture", {{"index", 2}}}, {"transmissionFactor", 1}}}}}},
      file);
  ASSERT_EQ(scene.embedded_images.size(), 2u);
  EXPECT_EQ(scene.embedded_images[0].bytes, "PNG or so");
  EXPECT_EQ(scene.embedded_images[0].name, "t.gltf#/images/0");
  EXPECT_EQ(scene.embedded_images[1].bytes, "ABC");
  ASSERT_EQ(scene.spectrum_textures.size(), 1u);
  const auto& base = std::get<ImageTexture>(scene.spectrum_textures[0].node);
  EXPECT_EQ(base.tint, (Rgb{0.5f, 0.25f, 1}));
  EXPECT_EQ(base.embedded, 0u);
  EXPECT_EQ(base.wrap, Wrap::mirror);
  EXPECT_EQ(base.filter, ImageFilter::point);
  EXPECT_EQ(base.encoding, Encoding::srgb);
  const auto image = [&](const FloatParameter& p) {
    return std::get<ImageTexture>(scene.float_textures.at(p.texture.value()).node);
  };
  const auto& mix = std::get<MixMaterial>(scene.materials.at(scene.shapes[0].material).node);
  EXPECT_EQ(image(mix.amount).channel, 2);
  EXPECT_EQ(image(mix.amount).scale, 0.5f);
  EXPECT_EQ(image(mix.amount).embedded, 1u);
  EXPECT_EQ(image(mix.amount).encoding, Encoding::linear);
  const auto& metal = std::get<ConductorMaterial>(scene.materials.at(mix.materials[1]).node);
  const auto& squared =
      std::get<ScaleTexture<FloatParameter>>(scene.float_textures.at(*metal.roughness.u.texture).node);
  EXPECT_EQ(squared.tex.texture, squared.scale.texture);
  EXPECT_EQ(image(squared.tex).channel, 1);
  const auto& see_through = std::get<MixMaterial>(scene.materials.at(mix.materials[0]).node);
  EXPECT_EQ(image(see_through.amount).channel, 0);
  EXPECT_EQ(image(see_through.amount).filename, "wood grain.png");
  EXPECT_EQ(scene.files.count("wood%20grain.png"), 1u);
  for (const Material& material : scene.materials) {
    const bool is_mix = std::holds_alternative<MixMaterial>(material.node);
    ASSERT_EQ(material.normal_map.has_value(), !is_mix);
    if (is_mix) continue;
    EXPECT_EQ(material.normal_map->strength, 0.5f);
    EXPECT_EQ(material.normal_map->image.encoding, Encoding::linear);
    EXPECT_EQ(material.normal_map->image.embedded, 1u);
  }
  const ImageTexture alpha = image(scene.shapes[0].alpha);
  EXPECT_EQ(alpha.channel, 3);
  EXPECT_EQ(alpha.scale, 0.75f);
  EXPECT_EQ(alpha.threshold, 0.5f);
}

TEST(GltfMaterial, TextureTransform) {
  GltfWriter file;
  file.add("images", {{"uri", "a.png"}});
  file.add("textures", {{"source", 0}});
  const json transform = {{"offset", {0.1, 0.2}}, {"rotation", 0.3}, {"scale", {2, 3}}, {"texCoord", 4}};
  const SceneDescription scene =
      with_material({{"pbrMetallicRoughness",
                      {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}},
                    file);
  const auto& image = std::get<ImageTexture>(scene.spectrum_textures.at(0).node);
  const Vec2 uv(0.6f, 0.7f);
  const float c = std::cos(0.3f), s = std::sin(0.3f);
  const Vec2 expected(c * 2 * uv.x + s * 3 * uv.y + 0.1f, -s * 2 * uv.x + c * 3 * uv.y + 0.2f);
  const auto& mapping = std::get<UvMapping>(image.mapping);
  const Vec2 st = mapping.linear * Vec2(uv.x, 1 - uv.y) + mapping.offset;
  EXPECT_NEAR(st.x, expected.x, 1e-6f);
  EXPECT_NEAR(st.y, 1 - expected.y, 1e-6f);
}

TEST(GltfMaterial, AlphaModes) {
  const auto alpha = [](const char* mode, float factor, float cutoff) {
    return with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, factor}}}},
                          {"alphaMode", mode},
                          {"alphaCutoff", cutoff}})
        .shapes.at(0)
        .alpha.value;
  };
  EXPECT_EQ(alpha("OPAQUE", 0.25f, 0.5f), 1);
  EXPECT_EQ(alpha("BLEND", 0.25f, 0.5f), 0.25f);
  EXPECT_EQ(alpha("MASK", 0.25f, 0.5f), 0);
  EXPECT_EQ(alpha("MASK", 0.25f, 0.25f), 1);
}

TEST(GltfMaterial, Emission) {
  const SceneDescription scene =
      with_material({{"emissiveFactor", {1, 0.5, 0.25}},
                     {"doubleSided", true},
                     {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10}}}}}});
  const description::AreaLight& light = scene.area_lights.at(0);
  EXPECT_EQ(rgb(light.radiance), (Rgb{1, 0.5f, 0.25f}));
  EXPECT_EQ(light.scale, 10);
  EXPECT_TRUE(light.two_sided);

  GltfWriter file;
  file.add("images", {{"uri", "a.png"}});
  file.add("textures", {{"source", 0}});
  const SceneDescription textured =
      with_material({{"emissiveFactor", {1, 0.5, 0.25}}, {"emissiveTexture", {{"index", 0}}}}, file);
  const SpectrumParameter& radiance = textured.area_lights.at(0).radiance;
  EXPECT_EQ(std::get<ImageTexture>(textured.spectrum_textures.at(radiance.texture.value()).node).tint,
            (Rgb{1, 0.5f, 0.25f}));
  EXPECT_EQ(textured.lights.size(), 1u);  // it may be black all but a few spots
}

// The closure at the middle of the only triangle, seen from the front.
template <class Closure>
Closure closure_of(const SceneDescription& description) {
  const Scene scene(description);
  const auto at = scene.intersect({{0.25f, 0.25f, 1}, {0, 0, -1}}, Wavelengths::rgb(0.5f));
  return std::get<Closure>(at.value().bsdf.get());
}

// One triangle with the colours red, green and blue at its corners; at (1/4, 1/4) they have the weights 1/2, 1/4, 1/4.
GltfWriter coloured(json material, std::size_t components) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2}, file.add("materials", std::move(material)));
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["COLOR_0"] = components == 3 ? file.accessor<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 255}, 3, true)
                                          : file.accessor<float>({1, 0, 0, 1, 0, 1, 0, 0.5f, 0, 0, 1, 0}, 4);
  file.node({{"mesh", 0}});
  return file;
}

TEST(GltfMaterial, VertexColoursMultiplyTheBaseColour) {
  const json dull = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0.8, 0.4, 1, 1}}}}};
  for (const std::size_t components : {3u, 4u}) {
    const Spectrum colour = closure_of<Plastic>(read_gltf(coloured(dull, components))).reflectance;
    EXPECT_NEAR(colour[0], 0.5f * 0.8f, 1e-5f) << components;
    EXPECT_NEAR(colour[1], 0.25f * 0.4f, 1e-5f) << components;
    EXPECT_NEAR(colour[2], 0.25f * 1, 1e-5f) << components;
  }
  // Without a material too, and the same material without colours is white.
  GltfWriter file = coloured(dull, 3);
  file.root["meshes"][0]["primitives"][0].erase("material");
  const SceneDescription metal = read_gltf(file);
  EXPECT_TRUE(std::get<ConductorMaterial>(metal.materials.at(metal.shapes[0].material).node).reflectance->texture);
  file = coloured(dull, 3);
  file.mesh(corners, {0, 1, 2}, 0);
  file.node({{"mesh", 1}});
  const SceneDescription both = read_gltf(file);
  ASSERT_EQ(both.shapes.size(), 2u);
  EXPECT_NE(both.shapes[0].material, both.shapes[1].material);
}

TEST(GltfMaterial, VertexAlphaBlends) {
  const json see_through = {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}};
  const Scene scene(read_gltf(coloured(see_through, 4)));
  int hits = 0;
  constexpr int rays = 4000;
  for (int i = 0; i < rays; ++i) {
    const float jitter = static_cast<float>(i) * 1e-6f;
    hits += scene.intersect({{0.25f + jitter, 0.25f, 1}, {0, 0, -1}}, Wavelengths::rgb(0.5f)).has_value() ? 1 : 0;
  }
  // 0.5 + 0.25 * 0.5, six standard deviations of a binomial distribution.
  EXPECT_NEAR(static_cast<double>(hits) / rays, 0.625, 6 * std::sqrt(0.625 * 0.375 / rays));
}

TEST(GltfMaterial, UnlitSurfacesEmitTheirColourAndAreNoLamps) {
  GltfWriter file = coloured({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1, 1, 1}}}},
                              {"emissiveFactor", {9, 9, 9}},
                              {"extensions", {{"KHR_materials_unlit", json::object()}}}},
                             3);
  file.mesh({{0, 0, -1}, {1, 0, -1}, {0, 1, -1}}, {0, 1, 2});
  file.node({{"mesh", 1}});
  const SceneDescription scene = read_gltf(file);
  EXPECT_EQ(scene.lights.size(), 1u) << "the studio";
  EXPECT_TRUE(scene.area_lights.at(0).two_sided);
  EXPECT_TRUE(closure_of<Diffuse>(scene).reflectance.is_black());
  const Scene built(scene);
  const auto at = built.intersect({{0.25f, 0.25f, 1}, {0, 0, -1}}, Wavelengths::rgb(0.5f));
  const auto& light = std::get<lanthorn::AreaLight>(built.lights().at(at->light.value()));
  const Spectrum seen = light.emitted({at->position, at->normal, at->uv}, {0, 0, 1}, Wavelengths::rgb(0.5f));
  EXPECT_NEAR(seen[0], 0.25f, 1e-5f);
  EXPECT_NEAR(seen[1], 0.25f, 1e-5f);
}

TEST(GltfMaterial, TransmittedLightHasTheBaseColour) {
  const auto glass = [](double roughness, double thickness) {
    return json{{"pbrMetallicRoughness",
                 {{"metallicFactor", 0}, {"roughnessFactor", roughness}, {"baseColorFactor", {0.25, 1, 0.5, 1}}}},
                {"extensions",
                 {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                  {"KHR_materials_volume", {{"thicknessFactor", thickness}}}}}};
  };
  // Of a volume the colour of the way through both interfaces, of a sheet that through it.
  const auto solid = closure_of<Dielectric>(with_material(glass(0.5, 1)));
  EXPECT_NEAR(solid.tint[0], 0.5f, 1e-6f);
  EXPECT_NEAR(solid.tint[2], std::sqrt(0.5f), 1e-6f);
  EXPECT_FLOAT_EQ(solid.alpha_x, 0.25f);
  const auto sheet = closure_of<ThinDielectric>(with_material(glass(0.5, 0)));
  EXPECT_NEAR(sheet.tint[0], 0.25f, 1e-6f);
  EXPECT_FLOAT_EQ(sheet.alpha_y, 0.25f);
  // White is a number, which is exact in spectral rendering, too.
  const auto clear = only_material<ThinDielectricMaterial>(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
       {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
  EXPECT_EQ(std::get<float>(clear.tint.value), 1);
}

TEST(GltfMaterial, DiffuseTransmissionIsMixedIn) {
  const SceneDescription leaf =
      with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                     {"extensions",
                      {{"KHR_materials_diffuse_transmission",
                        {{"diffuseTransmissionFactor", 0.25}, {"diffuseTransmissionColorFactor", {0, 1, 0}}}}}}});
  const auto& mix = std::get<MixMaterial>(leaf.materials.at(leaf.shapes[0].material).node);
  EXPECT_EQ(mix.amount.value, 0.25f);
  const auto& through = std::get<DiffuseTransmissionMaterial>(leaf.materials.at(mix.materials[1]).node);
  EXPECT_EQ(rgb(through.transmittance), (Rgb{0, 1, 0}));
  EXPECT_EQ(std::get<float>(through.reflectance.value), 0);
}

TEST(GltfMaterial, SheenIsClothOverTheDielectric) {
  const auto cloth = closure_of<Cloth>(with_material(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0.5, 0, 0, 1}}}},
       {"extensions", {{"KHR_materials_sheen", {{"sheenColorFactor", {0, 0.5, 1}}, {"sheenRoughnessFactor", 0.5}}}}}}));
  EXPECT_NEAR(cloth.base.reflectance[0], 0.5f, 1e-6f);
  EXPECT_NEAR(cloth.sheen[1], 0.5f, 1e-6f);
  EXPECT_FLOAT_EQ(cloth.alpha, 0.25f);
  const json none = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                     {"extensions", {{"KHR_materials_sheen", {{"sheenRoughnessFactor", 0.5}}}}}};
  closure_of<Plastic>(with_material(none));
}

TEST(GltfMaterial, IridescenceIsAFilm) {
  const json film = {{"iridescenceFactor", 1}, {"iridescenceIor", 1.8}, {"iridescenceThicknessMaximum", 300}};
  const auto with = [&](json material) {
    material["extensions"]["KHR_materials_iridescence"] = film;
    return with_material(material);
  };
  // A metal is a dielectric of its reflectance over black.
  const auto metal = closure_of<Plastic>(with({{"pbrMetallicRoughness", {{"baseColorFactor", {0.9, 0.5, 0.1, 1}}}}}));
  EXPECT_TRUE(metal.reflectance.is_black());
  EXPECT_NEAR(metal.f0[1], 0.5f, 1e-5f);
  EXPECT_EQ(metal.film.eta, 1.8f);
  EXPECT_EQ(metal.film.thickness, 300);
  const auto dull = closure_of<Plastic>(with({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}));
  EXPECT_EQ(dull.reflectance[0], 1);
  EXPECT_EQ(dull.film.thickness, 300);
  json glass = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}};
  EXPECT_EQ(closure_of<ThinDielectric>(with(glass)).film.eta, 1.8f);
  glass["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}};
  EXPECT_EQ(closure_of<Dielectric>(with(glass)).film.eta, 1.8f);
  for (const int metallic : {0, 1}) {
    const auto coated =
        closure_of<CoatedPlastic>(with({{"pbrMetallicRoughness", {{"metallicFactor", metallic}}},
                                        {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}}}));
    EXPECT_EQ(coated.base.film.thickness, 300);
    EXPECT_EQ(coated.base.reflectance.is_black(), metallic == 1);
  }
}

TEST(GltfMaterial, IridescenceVaries) {
  GltfWriter file;
  file.add("images", {{"uri", "a.png"}});
  file.add("textures", {{"source", 0}});
  const SceneDescription scene =
      with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                     {"extensions",
                      {{"KHR_materials_iridescence",
                        {{"iridescenceFactor", 0.25}, {"iridescenceThicknessTexture", {{"index", 0}}}}}}}},
                    file);
  const auto& mix = std::get<MixMaterial>(scene.materials.at(scene.shapes[0].material).node);
  EXPECT_EQ(mix.amount.value, 0.25f);
  EXPECT_FALSE(std::get<PlasticMaterial>(scene.materials.at(mix.materials[0]).node).film);
  const auto& film = std::get<PlasticMaterial>(scene.materials.at(mix.materials[1]).node).film;
  const auto& thickness = std::get<MixTexture<FloatParameter>>(scene.float_textures.at(*film->thickness.texture).node);
  EXPECT_EQ(thickness.tex1.value, 100);
  EXPECT_EQ(thickness.tex2.value, 400);
  EXPECT_EQ(std::get<ImageTexture>(scene.float_textures.at(*thickness.amount.texture).node).channel, 1);
  const auto error = [](const char* key) {
    GltfWriter bad;
    bad.mesh(corners, {0, 1, 2}, bad.add("materials", {{"extensions", {{"KHR_materials_iridescence", {{key, -1}}}}}}));
    bad.node({{"mesh", 0}});
    return gltf_error(bad);
  };
  const std::string place = "t.gltf#/materials/0/extensions/KHR_materials_iridescence/";
  EXPECT_EQ(error("iridescenceIor"), place + "iridescenceIor: must be at least 1");
  EXPECT_EQ(error("iridescenceThicknessMinimum"), place + "iridescenceThicknessMinimum: must not be negative");
}

TEST(GltfMaterial, AnisotropyStretchesAndTurns) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2},
            file.add("materials", {{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}},
                                   {"extensions",
                                    {{"KHR_materials_anisotropy",
                                      {{"anisotropyStrength", 0.5}, {"anisotropyRotation", std::acos(0.0)}}}}}}));
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
  attributes["TEXCOORD_0"] = file.accessor<float>({0, 1, 1, 1, 0, 0}, 2);
  file.node({{"mesh", 0}});
  const auto turned_to = [&] {
    const Scene scene(read_gltf(file));
    const auto at = scene.intersect({{0.25f, 0.25f, 1}, {0, 0, -1}}, Wavelengths::rgb(0.5f));
    const Conductor metal = std::get<Conductor>(at.value().bsdf.get());
    EXPECT_NEAR(metal.alpha_x, lerp(0.25f, 0.25f, 1.0f), 1e-6f);  // the strength squared
    EXPECT_FLOAT_EQ(metal.alpha_y, 0.25f);
    return at->shading.s;
  };
  EXPECT_NEAR(turned_to().y, 1, 1e-5f);  // u runs along x; a quarter turn counter-clockwise leads to y
  file.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
      file.accessor<float>({0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}, 4);
  EXPECT_NEAR(turned_to().x, 1, 1e-5f);  // with w = -1 the other way round, from y
}

TEST(GltfMaterial, BothAxesOfATextureWrapAsTheyAre) {
  GltfWriter file;
  file.add("images", {{"uri", "a.png"}});
  file.add("samplers", {{"wrapS", 33071}, {"wrapT", 10497}});
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  const SceneDescription scene =
      with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}, file);
  const auto& image = std::get<ImageTexture>(scene.spectrum_textures.at(0).node);
  EXPECT_EQ(image.wrap, Wrap::clamp);
  EXPECT_EQ(image.wrap_t, Wrap::repeat);
}

TEST(GltfMaterial, BasisTexturesAreNamedAndHaveFallbacks) {
  const auto with = [](json texture) {
    GltfWriter file;
    file.add("images", {{"uri", "bark.ktx2"}});
    file.add("images", {{"uri", "bark.png"}});
    file.add("textures", std::move(texture));
    file.root["extensionsUsed"] = {"KHR_texture_basisu"};
    file.root["extensionsRequired"] = {"KHR_texture_basisu"};
    return with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}, file);
  };
  const json basis = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  for (const json& texture : {basis, json{{"source", 0}}}) {
    const SceneDescription none = with(texture);
    EXPECT_TRUE(none.spectrum_textures.empty());
    EXPECT_EQ(
        warnings(none).at(0),
        "t.gltf#/textures/0: KHR_texture_basisu: KTX2 images such as \"bark.ktx2\" cannot be read: textures without "
        "another image are left out; convert them to PNG or WebP");
  }
  json both = basis;
  both["source"] = 1;
  const SceneDescription other = with(both);
  EXPECT_EQ(std::get<ImageTexture>(other.spectrum_textures.at(0).node).filename, "bark.png");
  EXPECT_EQ(warnings(other).size(), 1u);  // of the stand-ins
}

TEST(GltfMaterial, ApproximationsAreSaidOnce) {
  GltfWriter file;
  for (int i = 0; i < 2; ++i)
    file.mesh(corners, {0, 1, 2},
              file.add("materials", {{"extensions",
                                      {{"KHR_materials_sheen", json::object()},
                                       {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}}}}}}));
  file.node({{"mesh", 0}});
  file.node({{"mesh", 1}});
  file.root["extensionsUsed"] = {"KHR_materials_sheen", "VENDOR_thing"};
  EXPECT_EQ(
      warnings(read_gltf(file)),
      (std::vector<std::string>{
          "t.gltf#/extensionsUsed/1: extension \"VENDOR_thing\" is not supported: ignored",
          "t.gltf#/materials/0/extensions/KHR_materials_clearcoat: KHR_materials_sheen is ignored under a clear coat "
          "(and 1 more like it)",
          "t.gltf: the file has no camera and no light: a view of all of it from the front, in a studio of three soft "
          "lamps, stands in"}));
}

// Candela, lux and nits are one scale: a lamp of 3 cd at 1 m lights as much as one nit over 3 sr.
TEST(GltfLights, UnitsAndDirections) {
  GltfWriter file = one_mesh();
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 3}, {"color", {1, 0.5, 0}}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
      {{"type", "directional"}, {"intensity", 2}}};
  for (const int i : {0, 1, 2})
    file.node({{"translation", {1, 2, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const SceneDescription scene = read_gltf(file);
  ASSERT_EQ(scene.lights.size(), 3u);
  const auto& point = std::get<description::PointLight>(scene.lights[0].node);
  EXPECT_EQ(point.intensity.scale, 3);
  EXPECT_EQ(std::get<RgbSpectrum>(point.intensity.spectrum).rgb, (Rgb{1, 0.5f, 0}));
  EXPECT_EQ(scene.lights[0].light_to_world.point(point.from), Point(1, 2, 3));
  const auto& spot = std::get<description::SpotLight>(scene.lights[1].node);
  EXPECT_EQ(scene.lights[1].light_to_world.vector(spot.to - spot.from), Vec3(0, 0, -1));
  EXPECT_NEAR(spot.cone_angle, 28.6479f, 1e-3f);
  EXPECT_NEAR(spot.cone_delta_angle, 14.3239f, 1e-3f);
  EXPECT_EQ(spot.falloff, SpotFalloff::square);
  EXPECT_EQ(std::get<description::DistantLight>(scene.lights[2].node).radiance.scale, 2);
  EXPECT_TRUE(scene.view.film.measures_exposure);
}

TEST(GltfCamera, PerspectiveAndOrthographic) {
  const auto camera_scene = [](const json& camera) {
    GltfWriter file = one_mesh();
    file.add("cameras", camera);
    file.node({{"camera", 0}, {"translation", {0, 0, 5}}, {"scale", {3, 3, 3}}});
    return read_gltf(file);
  };
  const SceneDescription wide =
      camera_scene({{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 2}}}});
  EXPECT_EQ(wide.view.film.width, 1280);
  EXPECT_EQ(wide.view.film.height, 640);
  EXPECT_NEAR(std::get<PerspectiveCamera>(wide.view.camera.node).fov, 57.2958f, 1e-3f);
  EXPECT_EQ(wide.view.camera.camera_to_world.start.point({0, 0, 0}), Point(0, 0, 5));
  EXPECT_EQ(wide.view.camera.camera_to_world.start.point({1, 2, 3}), Point(1, 2, 2));  // right, up, forward
  const SceneDescription tall =
      camera_scene({{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 0.5}}}});
  EXPECT_EQ(tall.view.film.width, 640);
  EXPECT_EQ(tall.view.film.height, 1280);
  EXPECT_NEAR(std::tan(std::get<PerspectiveCamera>(tall.view.camera.node).fov / 2 * pi / 180), std::tan(0.5f) / 2,
              1e-5f);
  const SceneDescription flat =
      camera_scene({{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"zfar", 9}, {"znear", 1}}}});
  EXPECT_EQ(flat.view.film.height, 640);
  const View view = make_view(flat.view);
  // The right edge of the film lies 4 to the right, the upper one 2 up.
  EXPECT_NEAR(view.camera.sample_ray({1280, 0}, {0.5f, 0.5f}, 0).ray.origin.x, 4, 1e-5f);
  EXPECT_NEAR(view.camera.sample_ray({1280, 0}, {0.5f, 0.5f}, 0).ray.origin.y, 2, 1e-5f);
}

// A camera that sees nothing shows a black picture, whatever the exporter meant.
TEST(GltfCamera, OneThatSeesNothingIsReplaced) {
  const auto is_replaced = [](const nlohmann::json& camera, const Vec3& at) {
    GltfWriter file = one_mesh();  // in the plane z = 0, from 0 to 1 in x and y
    file.add("cameras", camera);
    file.node({{"camera", 0}, {"translation", {at.x, at.y, at.z}}});
    const SceneDescription scene = read_gltf(file);
    return scene.warnings.back().message.starts_with("the file has no camera that sees anything and no light");
  };
  const auto replaced = [&](float z, float znear) {
    return is_replaced({{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 2}, {"znear", znear}}}},
                       {0, 0, z});
  };
  EXPECT_FALSE(replaced(5, 4.9f));
  EXPECT_TRUE(replaced(5, 5.1f)) << "the mesh is nearer than viewers show it";
  EXPECT_TRUE(replaced(-1, 0.1f)) << "the mesh is behind the camera";
  // At a distance of 5 it sees 5.46 to the left and right, and 2.73 up and down.
  const nlohmann::json perspective = {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 2}}}};
  const nlohmann::json orthographic = {{"type", "orthographic"},
                                       {"orthographic", {{"xmag", 5.46}, {"ymag", 2.73}, {"zfar", 9}, {"znear", 0}}}};
  for (const nlohmann::json& camera : {perspective, orthographic})
    for (const auto& [x, y, outside] :
         {std::tuple(6.3f, 0.0f, false), std::tuple(6.6f, 0.0f, true), std::tuple(-5.3f, 0.0f, false),
          std::tuple(-5.6f, 0.0f, true), std::tuple(0.0f, 3.6f, false), std::tuple(0.0f, 3.9f, true),
          std::tuple(0.0f, -2.6f, false), std::tuple(0.0f, -2.9f, true)})
      EXPECT_EQ(is_replaced(camera, {x, y, 5}), outside) << camera << ' ' << x << ' ' << y;
}

TEST(GltfCompression, Draco) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(1);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const std::vector<Vec2> uvs = {{0, 0}, {1, 0}, {0, 1}};
  builder.SetAttributeValuesForFace(position, draco::FaceIndex(0), &corners[0], &corners[1], &corners[2]);
  builder.SetAttributeValuesForFace(uv, draco::FaceIndex(0), &uvs[0], &uvs[1], &uvs[2]);
  const auto mesh = builder.Finalize();
  draco::ExpertEncoder encoder(*mesh);
  draco::EncoderBuffer buffer;
  ASSERT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  const std::string bytes(buffer.data(), buffer.size());
  const auto file_with = [&](const std::string& data) {
    return one_mesh([&](GltfWriter& file, json& primitive) {
      primitive["extensions"]["KHR_draco_mesh_compression"] = {
          {"bufferView", file.view(data)}, {"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}};
    });
  };
  const TriangleMesh decoded = mesh_of(read_gltf(file_with(bytes)).shapes.at(0));
  ASSERT_EQ(decoded.triangles.size(), 1u);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t i = decoded.triangles[0][k];
    EXPECT_EQ(decoded.uvs.at(i).x, decoded.positions.at(i).x);
    EXPECT_EQ(decoded.uvs.at(i).y, 1 - decoded.positions.at(i).y);
  }
  EXPECT_NE(
      gltf_error(file_with(bytes.substr(0, bytes.size() / 2)).text())
          .find("t.gltf#/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: the compressed mesh cannot be "
                "decoded: "),
      std::string::npos);
  // Found by fuzzing.
  const std::string booleans = read_file(LANTHORN_SOURCE_DIR "/tests/fuzz/corpus/gltf/draco-booleans");
  EXPECT_NE(gltf_error(booleans).find("the attribute consists of booleans"), std::string::npos) << gltf_error(booleans);
}

TEST(GltfCompression, Meshopt) {
  const test::SphereMesh sphere = test::sphere_mesh(1, 8, 8);
  std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(sphere.positions.size(), sizeof(Point)));
  vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), sphere.positions.data(),
                                             sphere.positions.size(), sizeof(Point)));
  std::vector<unsigned char> indices(meshopt_encodeIndexBufferBound(sphere.indices.size(), sphere.positions.size()));
  indices.resize(
      meshopt_encodeIndexBuffer(indices.data(), indices.size(), sphere.indices.data(), sphere.indices.size()));
  std::string extension = "EXT_meshopt_compression";
  const auto file_with = [&](const std::vector<unsigned char>& vertex_bytes, std::size_t count) {
    GltfWriter file;
    file.mesh(sphere.positions, sphere.indices);
    file.node({{"mesh", 0}});
    const auto compress = [&](std::size_t accessor, const std::vector<unsigned char>& data, const char* mode,
                              std::size_t stride, std::size_t elements) {
      const std::size_t source = file.view({reinterpret_cast<const char*>(data.data()), data.size()});
      const json from = file.root["bufferViews"][source];
      json& view = file.root["bufferViews"][file.root["accessors"][accessor]["bufferView"].get<std::size_t>()];
      view["extensions"][extension] = {{"buffer", 0},
                                       {"byteOffset", from["byteOffset"]},
                                       {"byteLength", from["byteLength"]},
                                       {"byteStride", stride},
                                       {"count", elements},
                                       {"mode", mode}};
    };
    compress(0, vertex_bytes, "ATTRIBUTES", sizeof(Point), count);
    compress(1, indices, "TRIANGLES", 4, sphere.indices.size());
    return file;
  };
  const SceneDescription decoded_scene = read_gltf(file_with(vertices, sphere.positions.size()));
  const TriangleMesh& decoded = mesh_of(decoded_scene.shapes.at(0));
  EXPECT_EQ(decoded.positions, sphere.positions);
  ASSERT_EQ(decoded.triangles.size() * 3, sphere.indices.size());
  // The codec may turn triangles round, as it does not keep their first corner.
  for (std::size_t i = 0; i < decoded.triangles.size(); ++i) {
    const auto& t = decoded.triangles[i];
    const std::array<std::uint32_t, 3> s = {sphere.indices[3 * i], sphere.indices[3 * i + 1],
                                            sphere.indices[3 * i + 2]};
    EXPECT_TRUE(t == s || (t[0] == s[1] && t[1] == s[2] && t[2] == s[0]) ||
                (t[0] == s[2] && t[1] == s[0] && t[2] == s[1]));
  }
  const std::string at = "t.gltf#/bufferViews/0/extensions/EXT_meshopt_compression: ";
  std::vector<unsigned char> damaged = vertices;
  damaged.resize(damaged.size() / 2);
  EXPECT_EQ(gltf_error(file_with(damaged, sphere.positions.size()).text()), at + "the compressed data is damaged");
  EXPECT_EQ(gltf_error(file_with(vertices, 4000000000u).text()),
            at + "the compressed data is too short for 4000000000 elements of 12 bytes");
  extension = "KHR_meshopt_compression";
  GltfWriter of_khronos = file_with(vertices, sphere.positions.size());
  of_khronos.root["extensionsRequired"] = {extension};
  EXPECT_EQ(mesh_of(read_gltf(of_khronos).shapes.at(0)).positions, sphere.positions);
  vertices[0] |= 1;
  EXPECT_NE(gltf_error(file_with(vertices, sphere.positions.size()).text()).find("version 1 of the format"),
            std::string::npos);
}

TEST(GltfErrors, SyntaxHasLineAndColumn) {
  EXPECT_EQ(gltf_error("{\n  \"asset\": {\"version\": }\n}").substr(0, 12), "t.gltf:2:24:");
  EXPECT_EQ(gltf_error("").substr(0, 11), "t.gltf:1:1:");
  EXPECT_EQ(gltf_error("[]"), "t.gltf: the file's JSON must be an object");
  EXPECT_EQ(gltf_error(std::string(100000, '[')), "t.gltf:1:201: the JSON is nested more than 200 levels deep");
  EXPECT_EQ(gltf_error(R"(["[[\"[[", )" + std::string(300, '[')).substr(0, 13), "t.gltf:1:211:");
}

// Meshes have materials of their own, which are shown as long as nobody chooses a variant.
TEST(Gltf, FilesThatRequireVariantsAreRead) {
  const test::SphereMesh sphere = test::sphere_mesh(1, 8, 8);
  GltfWriter file;
  file.mesh(sphere.positions, sphere.indices);
  file.node({{"mesh", 0}});
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_materials_variants"};
  file.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "blue"}}};
  const SceneDescription scene = read_gltf(file);
  EXPECT_EQ(scene.shapes.size(), 1u);
  for (const Warning& warning : scene.warnings) EXPECT_EQ(warning.message.find("extension"), std::string::npos);
}

// A parser that looked at all elements of an array after each took 55 seconds.
TEST(Gltf, LongArraysTakeTimeInProportionToTheirLength) {
  constexpr int nodes = 200000;
  std::string text = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[)";
  for (int i = 1; i < nodes; ++i) text += R"({"children":[)" + std::to_string(i) + R"(],"translation":[0,0,1]},)";
  const std::clock_t start = std::clock();
  const SceneDescription scene = read_gltf(text + "{}]}");
  EXPECT_LT(std::clock() - start, 5 * CLOCKS_PER_SEC);
  EXPECT_TRUE(scene.shapes.empty());
}

TEST(GltfErrors, Container) {
  const std::string file = one_mesh().binary();
  EXPECT_EQ(gltf_error(file.substr(0, 10)), "t.gltf: the file ends inside of its header");
  EXPECT_EQ(gltf_error(file.substr(0, 40)),
            "t.gltf: the file has 40 bytes, but its header says " + std::to_string(file.size()));
  std::string other = file;
  other[4] = 1;
  EXPECT_EQ(gltf_error(other), "t.gltf: is version 1 of glTF's binary container: only 2 is read");
  other = file;
  other[15] = '\x7f';
  EXPECT_EQ(gltf_error(other), "t.gltf: the file ends inside of a chunk");
  other = file;
  other[16] = 'X';
  EXPECT_EQ(gltf_error(other), "t.gltf: the file has no JSON chunk");
}

// What is wrong with the file if the value at `pointer` is replaced.
std::string broken(const char* pointer, const json& value, GltfWriter file = one_mesh()) {
  json root = json::parse(file.text());
  root[json::json_pointer(pointer)] = value;
  return gltf_error(root.dump());
}

TEST(GltfErrors, NameThePlace) {
  EXPECT_EQ(broken("/asset/version", "1.0"), "t.gltf#/asset/version: only glTF 2 is read, not \"1.0\"");
  EXPECT_EQ(broken("/asset", json::object()), "t.gltf#/asset: needs the member \"version\"");
  EXPECT_EQ(
      broken("/extensionsRequired", {"EXT_x"}),
      "t.gltf#/extensionsRequired/0: the file cannot be read without extension \"EXT_x\", which is not supported");
  EXPECT_EQ(broken("/scene", 3), "t.gltf#/scene: is 3, but there are 1 scenes");
  EXPECT_EQ(broken("/scenes/0/nodes/0", -1), "t.gltf#/scenes/0/nodes/0: must be a whole number, not negative");
  EXPECT_EQ(broken("/nodes/0/mesh", 9), "t.gltf#/nodes/0/mesh: is 9, but there are 1 meshes");
  EXPECT_EQ(broken("/nodes/0/matrix", {1, 2}), "t.gltf#/nodes/0/matrix: needs 16 numbers, has 2");
  EXPECT_EQ(broken("/nodes/0/translation", "up"), "t.gltf#/nodes/0/translation: must be an array");
  EXPECT_EQ(broken("/nodes/0/scale", {1, 1, 1e300}), "t.gltf#/nodes/0/scale/2: is too large a number");
  EXPECT_EQ(broken("/nodes/0/children", {0}),
            "t.gltf#/nodes/0: the node is reached twice: it has two parents, or is its own ancestor");
  EXPECT_EQ(broken("/meshes/0/primitives/0/mode", 7), "t.gltf#/meshes/0/primitives/0/mode: there is no mode 7");
  EXPECT_EQ(broken("/meshes/0/primitives/0/material", 0),
            "t.gltf#/meshes/0/primitives/0/material: is 0, but there are 0 materials");
  EXPECT_EQ(broken("/meshes/0/primitives/0/indices", 0),
            "t.gltf#/meshes/0/primitives/0/indices: accessor 0 is a VEC3, but elements of 1 numbers are needed");
  EXPECT_EQ(broken("/accessors/0/componentType", 5124),
            "t.gltf#/accessors/0/componentType: there is no component type 5124");
  EXPECT_EQ(broken("/accessors/0/type", "VEC9"), "t.gltf#/accessors/0/type: there is no accessor type \"VEC9\"");
  EXPECT_EQ(broken("/accessors/1/componentType", 5126),
            "t.gltf#/meshes/0/primitives/0/indices: indices must be unsigned integers");
}

TEST(GltfErrors, NothingLiesOutsideOfItsBuffer) {
  EXPECT_EQ(broken("/accessors/0/count", 4),
            "t.gltf#/accessors/0: 4 elements do not fit into the buffer view: only 3 do");
  EXPECT_EQ(broken("/accessors/0/count", 9007199254740991),
            "t.gltf#/accessors/0: 9007199254740991 elements do not fit into the buffer view: only 3 do");
  EXPECT_EQ(broken("/accessors/0/byteOffset", 12),
            "t.gltf#/accessors/0: 3 elements do not fit into the buffer view: only 2 do");
  EXPECT_EQ(broken("/accessors/0/byteOffset", 1000000),
            "t.gltf#/accessors/0: 3 elements do not fit into the buffer view: only 0 do");
  EXPECT_EQ(broken("/bufferViews/0/byteStride", 4),
            "t.gltf#/accessors/0: an element has 12 bytes, but the byteStride is only 4");
  EXPECT_EQ(broken("/bufferViews/0/byteStride", 100000),
            "t.gltf#/bufferViews/0/byteStride: is too large: 256 is the most");
  EXPECT_EQ(broken("/bufferViews/0/byteOffset", 20),
            "t.gltf#/bufferViews/0: bytes 20 to 56 lie outside of the buffer, which has 48");
  EXPECT_EQ(broken("/bufferViews/0/byteOffset", 9223372036854775807),
            "t.gltf#/bufferViews/0: bytes 9223372036854775807 to 9223372036854775843 lie outside of the buffer, which "
            "has 48");
  EXPECT_EQ(broken("/buffers/0/byteLength", 49), "t.gltf#/buffers/0: byteLength is 49, but there are only 48 bytes");
  EXPECT_EQ(broken("/buffers/0/uri", "none.bin"), "t.gltf#/buffers/0/uri: none.bin: no such file");
  EXPECT_EQ(broken("/buffers/0/uri", "https://example.org/a.bin"),
            "t.gltf#/buffers/0/uri: only data URIs and relative URIs that stay in the file's folder are "
            "read, not \"https://example.org/a.bin\"");
  EXPECT_EQ(broken("/buffers/0/uri", "data:;base64,@@"), "t.gltf#/buffers/0/uri: the data URI is not valid base64");
  EXPECT_EQ(broken("/buffers/0/uri", "data:text/plain,abc"), "t.gltf#/buffers/0/uri: a data URI must be in base64");
  EXPECT_EQ(broken("/accessors/0/count", 2),
            "t.gltf#/meshes/0/primitives/0/indices: index number 2 is 2, but there are 2 vertices");
  const auto zeros = one_mesh([](GltfWriter& file, json& primitive) {
    primitive["attributes"]["POSITION"] =
        file.add("accessors", GltfWriter::description<float>(std::nullopt, 4000000000u, 3, false));
    primitive.erase("indices");
  });
  EXPECT_EQ(gltf_error(zeros.text()),
            "t.gltf#/accessors/2: 4000000000 elements without a bufferView are too many: 1048576 are the most");
  const auto sparse = one_mesh([](GltfWriter& file, json& primitive) {
    json accessor = GltfWriter::description<float>(std::nullopt, 3, 3, false);
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", file.view({"\2\1", 2})}, {"componentType", 5121}}},
                          {"values", {{"bufferView", file.view(std::string(24, '\0'))}}}};
    primitive["attributes"]["POSITION"] = file.add("accessors", accessor);
  });
  EXPECT_EQ(gltf_error(sparse.text()),
            "t.gltf#/accessors/2/sparse/indices: the indices must increase and be below 3; number 1 is 1");
}

// A floor, a lamp and four balls, with all that the tests are about.
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
  // 126: a folder of PATH is not ours to look into.
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

// The same mesh of glass, lights and camera, once in each format.
TEST(GltfRender, GlassSphereIsTheSameAsInPbrtForm) {
  const test::SphereMesh sphere = test::sphere_mesh(1, 24, 32);
  std::string indices = "[";
  for (const std::uint32_t i : sphere.indices) indices += std::to_string(i) + " ";
  const std::vector<float> normals = GltfWriter::flat(sphere.positions);
  const SceneDescription pbrt = read_pbrt_string(
      "Scale -1 1 1 LookAt 0 1 5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40\n"
      "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 24\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [0.4 0.5 0.6]\n"
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [8 8 8] Translate 0 4 0 Shape \"sphere\" \"float radius\" "
      "0.5 "
      "AttributeEnd\n"
      "Material \"dielectric\" \"float eta\" 1.45\n"
      "Shape \"trianglemesh\" \"point3 P\" " +
          list(GltfWriter::flat(sphere.positions)) + " \"normal N\" " + list(normals) + " \"integer indices\" " +
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
  // All but the glass comes from the other file.
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
}  // namespace lanthorn::gltf_test
