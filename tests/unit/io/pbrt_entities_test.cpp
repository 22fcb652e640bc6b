// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What pbrt-v4's directives mean: the parameters and defaults of materials, textures, lights, shapes, cameras and film.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lanthorn/scene.h"
#include "support/error_text.h"
#include "support/measured_conductor.h"
#include "support/temporary_dir.h"

namespace lanthorn::pbrt_entities_test {
namespace {

using namespace description;

SceneDescription read(const std::string& text) { return read_pbrt_string(text, "scenes", "t.pbrt"); }

std::string error_of(const std::string& text) {
  return test::error_text([&] { read(text); });
}

void expect_warnings(const SceneDescription& scene, const std::vector<std::string>& expected) {
  std::vector<std::string> messages;
  for (const Warning& w : scene.warnings) messages.push_back(w.message);
  EXPECT_EQ(messages, expected);
}

// The material of a scene with this text after WorldBegin.
template <class T>
T material(const std::string& text) {
  const SceneDescription scene = read("WorldBegin " + text);
  expect_warnings(scene, {});
  return std::get<T>(scene.materials.at(1).node);
}

float constant(const SpectrumValue& value) { return std::get<float>(value); }
std::string name(const SpectrumValue& value) { return std::get<NamedSpectrum>(value).name; }
Rgb rgb(const SpectrumValue& value) { return std::get<RgbSpectrum>(value).rgb; }

TEST(PbrtValues, SpectraOfEveryForm) {
  const test::TemporaryDir dir;
  dir.write("a.spd", "# measured\n400 0.5\n700 .25 # end\n");
  const std::string text = R"(WorldBegin MakeNamedMaterial "m" "string type" "diffuse" )";
  const auto reflectance = [&](const std::string& parameter) {
    const auto scene = read_pbrt_string(text + parameter, dir.path(), "t.pbrt");
    return std::get<DiffuseMaterial>(scene.materials.at(1).node).reflectance.value;
  };
  EXPECT_EQ(constant(reflectance(R"("float reflectance" 0.25)")), 0.25f);
  EXPECT_EQ(constant(reflectance(R"("float reflectance" [ 0.25 ])")), 0.25f);
  EXPECT_EQ(rgb(reflectance(R"("rgb reflectance" [.1 .2 .3])")), (Rgb{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(std::get<BlackbodySpectrum>(reflectance(R"("blackbody reflectance" 2700)")).kelvin, 2700);
  EXPECT_EQ(name(reflectance(R"("spectrum reflectance" "metal-Ag-k")")), "metal-Ag-k");
  EXPECT_EQ(name(reflectance(R"("spectrum reflectance" [ "glass-BK7" ])")), "glass-BK7");
  const auto pairs = std::get<SampledSpectrum>(reflectance(R"("spectrum reflectance" [400 .1 500 .2])"));
  EXPECT_EQ(pairs.nm, (std::vector<float>{400, 500}));
  EXPECT_EQ(pairs.values, (std::vector<float>{0.1f, 0.2f}));
  const auto file = std::get<SampledSpectrum>(reflectance(R"("spectrum reflectance" "a.spd")"));
  EXPECT_EQ(file.nm, (std::vector<float>{400, 700}));
  EXPECT_EQ(file.values, (std::vector<float>{0.5f, 0.25f}));
}

TEST(PbrtValues, SpectrumErrors) {
  const std::string start = R"(WorldBegin Material "diffuse" )",
                    where = R"(t.pbrt:1:31: parameter "reflectance" of Material "diffuse" )";
  const auto error = [&](const std::string& parameter) { return error_of(start + parameter); };
  EXPECT_EQ(error(R"("spectrum reflectance" [400 .1 500])"),
            where + "needs pairs of a wavelength and a value, has 3 numbers");
  EXPECT_EQ(error(R"("spectrum reflectance" [])"), where + "needs pairs of a wavelength and a value, has 0 numbers");
  EXPECT_EQ(error(R"("spectrum reflectance" ["a" 5])"),
            R"(t.pbrt:1:31: spectrum "reflectance" mixes names and numbers)");
  EXPECT_EQ(error(R"("spectrum reflectance" "none.spd")"),
            where + R"(names the spectrum "none.spd", which is not built in; scenes/none.spd: no such file)");
  EXPECT_EQ(error(R"("blackbody reflectance" 0)"), where + "needs a temperature above 0 kelvin");
  EXPECT_EQ(error(R"("bool reflectance" true)"), where + "must be a spectrum (rgb, blackbody or spectrum), not bool");
}

TEST(PbrtValues, BooleansQuotedOrNot) {
  for (const std::string yes : {"true", "[true]", R"("true")", R"([ "true" ])"})
    EXPECT_TRUE(read(R"(Integrator "path" "bool regularize" )" + yes + " WorldBegin").hints.regularize) << yes;
  EXPECT_FALSE(read(R"(Integrator "path" "bool regularize" "false" WorldBegin)").hints.regularize);
}

TEST(PbrtValues, PointsVectorsAndNormalsInAnySpelling) {
  const auto scene = read(
      R"(WorldBegin LightSource "spot" "point from" [1 2 3] "vector3 to" [4 5 6]
Shape "trianglemesh" "vector P" [0 0 0 1 0 0 0 1 0] "vector3 N" [0 0 1 0 0 1 0 0 1] "normal S" [1 0 0 1 0 0 1 0 0] "vector2 uv" [0 0 1 0 0 1])");
  const auto& light = std::get<SpotLight>(scene.lights[0].node);
  EXPECT_EQ(light.from, Point(1, 2, 3));
  EXPECT_EQ(light.to, Point(4, 5, 6));
  const auto& mesh = std::get<TriangleMesh>(scene.shapes[0].geometry);
  EXPECT_EQ(mesh.positions[1], Point(1, 0, 0));
  EXPECT_EQ(mesh.normals[2], Vec3(0, 0, 1));
  EXPECT_EQ(mesh.tangents[0], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.uvs[2], Vec2(0, 1));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
}

TEST(PbrtMaterials, Defaults) {
  EXPECT_EQ(constant(material<DiffuseMaterial>(R"(Material "diffuse")").reflectance.value), 0.5f);
  const auto transmission = material<DiffuseTransmissionMaterial>(R"(Material "diffusetransmission")");
  EXPECT_EQ(constant(transmission.reflectance.value), 0.25f);
  EXPECT_EQ(constant(transmission.transmittance.value), 0.25f);
  EXPECT_EQ(transmission.scale, 1);
  const auto conductor = material<ConductorMaterial>(R"(Material "conductor")");
  EXPECT_FALSE(conductor.reflectance.has_value());
  EXPECT_EQ(name(conductor.eta.value), "metal-Cu-eta");
  EXPECT_EQ(name(conductor.k.value), "metal-Cu-k");
  EXPECT_EQ(conductor.roughness.u.value, 0);
  EXPECT_TRUE(conductor.roughness.remap);
  EXPECT_EQ(constant(material<DielectricMaterial>(R"(Material "dielectric")").eta), 1.5f);
  EXPECT_EQ(constant(material<ThinDielectricMaterial>(R"(Material "thindielectric")").eta), 1.5f);
  const Coat coat = material<CoatedDiffuseMaterial>(R"(Material "coateddiffuse")").coat;
  EXPECT_EQ(coat.roughness.u.value, 0);
  EXPECT_EQ(coat.thickness.value, 0.01f);
  EXPECT_EQ(constant(coat.eta), 1.5f);
  EXPECT_EQ(constant(coat.albedo.value), 0);
  EXPECT_EQ(coat.g.value, 0);
  EXPECT_EQ(coat.max_depth, 10);
  EXPECT_EQ(coat.samples, 1);
  for (const std::string kind : {"interface", "none", ""}) material<InterfaceMaterial>("Material \"" + kind + "\"");
  EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(read("WorldBegin").materials.at(0).node));
}

TEST(PbrtMaterials, Parameters) {
  const auto rough = material<DielectricMaterial>(
      R"(Material "dielectric" "spectrum eta" "glass-F11" "float roughness" .3 "float vroughness" .4 "bool )"
      R"(remaproughness" )"
      "false");
  EXPECT_EQ(name(rough.eta), "glass-F11");
  EXPECT_EQ(rough.roughness.u.value, 0.3f);
  EXPECT_EQ(rough.roughness.v.value, 0.4f);
  EXPECT_FALSE(rough.roughness.remap);
  const auto coated = material<CoatedConductorMaterial>(
      R"(Material "coatedconductor" "float interface.roughness" .1 "float conductor.uroughness" .2 "float )"
      R"(conductor.vroughness" )"
      R"(.3 "rgb conductor.eta" [1 2 3] "spectrum conductor.k" "metal-Al-k" "float interface.eta" 1.3 "float )"
      R"(thickness" .02 )"
      R"("float g" .5 "rgb albedo" [.1 .2 .3] "integer maxdepth" 5 "integer nsamples" 2)");
  EXPECT_EQ(coated.coat.roughness.v.value, 0.1f);
  EXPECT_EQ(coated.conductor_roughness.u.value, 0.2f);
  EXPECT_EQ(coated.conductor_roughness.v.value, 0.3f);
  EXPECT_EQ(rgb(coated.eta.value), (Rgb{1, 2, 3}));
  EXPECT_EQ(name(coated.k.value), "metal-Al-k");
  EXPECT_EQ(constant(coated.coat.eta), 1.3f);
  EXPECT_EQ(coated.coat.thickness.value, 0.02f);
  EXPECT_EQ(coated.coat.g.value, 0.5f);
  EXPECT_EQ(coated.coat.max_depth, 5);
  EXPECT_EQ(coated.coat.samples, 2);
  const auto metal = material<ConductorMaterial>(R"(Material "conductor" "rgb reflectance" [.9 .8 .7])");
  EXPECT_EQ(rgb(metal.reflectance->value), (Rgb{0.9f, 0.8f, 0.7f}));
}

TEST(PbrtMaterials, MixNamesEarlierMaterials) {
  const auto scene = read(
      R"(WorldBegin MakeNamedMaterial "a" "string type" "diffuse" MakeNamedMaterial "b" "string type" "conductor"
MakeNamedMaterial "ab" "string type" "mix" "string materials" ["a" "b"] "float amount" .25
Material "mix" "string materials" ["ab" "a"] Shape "sphere")");
  const auto& outer = std::get<MixMaterial>(scene.materials[scene.shapes[0].material].node);
  EXPECT_EQ(scene.materials[outer.materials[0]].name, "ab");
  EXPECT_EQ(outer.amount.value, 0.5f);
  const auto& inner = std::get<MixMaterial>(scene.materials[outer.materials[0]].node);
  EXPECT_EQ(scene.materials[inner.materials[0]].name, "a");
  EXPECT_EQ(scene.materials[inner.materials[1]].name, "b");
  EXPECT_EQ(inner.amount.value, 0.25f);
}

TEST(PbrtMaterials, Hair) {
  const auto dark = material<HairMaterial>(R"(Material "hair")");
  EXPECT_EQ(dark.eumelanin.value, 1.3f);
  const auto red = material<HairMaterial>(R"(Material "hair" "float pheomelanin" 2 "float beta_n" .1)");
  EXPECT_EQ(red.eumelanin.value, 0);
  EXPECT_EQ(red.pheomelanin.value, 2);
  EXPECT_EQ(red.beta_n.value, 0.1f);
  const auto blue = material<HairMaterial>(R"(Material "hair" "rgb reflectance" [0 0 .5])");
  EXPECT_EQ(rgb(blue.color->value), (Rgb{0, 0, 0.5f}));
  EXPECT_FALSE(blue.sigma_a);
}

TEST(PbrtMaterials, ReflectancesAboveOneAreNamed) {
  const auto scene = read(
      R"(WorldBegin Material "hair" "float beta_m" .3 Material "hair"
Material "diffuse" "rgb reflectance" [1 2 1])");
  expect_warnings(scene, {R"(parameter "reflectance" of Material "diffuse" is a reflectance above 1: clamped to 1)"});
}

TEST(PbrtMaterials, MeasuredOnesAreReadOnce) {
  const test::TemporaryDir dir;
  dir.write("a.bsdf", test::bsdf_file(test::measure({.indices = {{1, 2}, {1, 3}, {1, 4}},
                                                     .wavelengths = {400, 500, 600},
                                                     .elevations = 2,
                                                     .normals = 4,
                                                     .warped = 3})));
  dir.write("b.bsdf", "tensor_file");
  const auto read_text = [&](const std::string& text) { return read_pbrt_string(text, dir.path(), "t.pbrt"); };
  const auto scene = read_text(
      R"(WorldBegin Material "measured" "string filename" "a.bsdf"
Material "measured" "string filename" "a.bsdf")");
  expect_warnings(scene, {});
  ASSERT_EQ(scene.measured_brdfs.size(), 1u);
  EXPECT_EQ(scene.measured_brdfs[0]->wavelengths, (std::vector<float>{400, 500, 600}));
  EXPECT_EQ(std::get<MeasuredMaterial>(scene.materials.at(1).node).brdf, 0u);
  EXPECT_EQ(std::get<MeasuredMaterial>(scene.materials.at(2).node).brdf, 0u);
  EXPECT_TRUE(scene.files.contains("a.bsdf"));

  const auto message = [&](const std::string& text) {
    return test::error_text([&] { read_text(R"(WorldBegin Material "measured" )" + text); });
  };
  EXPECT_EQ(message(R"("string filename" "b.bsdf")"),
            "t.pbrt:1:32: " + (dir.path() / "b.bsdf").string() + ": is not a tensor file");
  EXPECT_TRUE(message(R"("string filename" "c.bsdf")").starts_with("t.pbrt:1:32: "));
  EXPECT_TRUE(message("").starts_with("t.pbrt:1:12: "));
}

TEST(PbrtMaterials, SubsurfaceIsABoundaryWithAMediumInside) {
  const auto scene = read(
      R"(WorldBegin MakeNamedMedium "m" "string type" "homogeneous" MediumInterface "" "m"
Material "subsurface" "rgb reflectance" [0 1 .5] "float mfp" .5 "float eta" 1.4 Shape "sphere"
Material "subsurface" "string name" "Marble" "float scale" 1000)");
  expect_warnings(scene, {});
  const Material& material = scene.materials[scene.shapes[0].material];
  EXPECT_EQ(std::get<float>(std::get<DielectricMaterial>(material.node).eta), 1.4f);
  ASSERT_EQ(material.interior, 1u);
  const Rgb scattered = rgb(scene.media[1].sigma_s), absorbed = rgb(scene.media[1].sigma_a);
  EXPECT_EQ(scattered.r, 0);
  EXPECT_NEAR(scattered.g, 2, 0.01f);
  EXPECT_NEAR(scattered.b + absorbed.b, 2, 1e-5f);
  EXPECT_EQ(rgb(scene.media[2].sigma_s), (Rgb{2.19f, 2.62f, 3.00f}));
  EXPECT_EQ(scene.media[2].scale, 1000);
}

TEST(PbrtMedia, GridsAndTheirErrors) {
  const auto scene = read(
      R"(WorldBegin MakeNamedMedium "g" "string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 1 "float density" [1 2] "point3 p0" [-1 -1 -1] "rgb Le" [1 1 1] "float Lescale" [0 3]
MakeNamedMedium "c" "string type" "rgbgrid" "rgb sigma_s" [1 2 3] "rgb Le" [1 1 1] "rgb sigma_a" [0 0 1])");
  expect_warnings(scene, {});
  const auto& grid = std::get<GridDensity>(scene.media[0].density);
  EXPECT_EQ(std::get<MediumGrid<float>>(grid.density).values, (std::vector<float>{1, 2}));
  EXPECT_EQ(std::get<MediumGrid<float>>(grid.density).low, Point(-1));
  EXPECT_EQ(grid.emission_factor->values, (std::vector<float>{0, 3}));
  EXPECT_EQ(std::get<RgbGridDensity>(scene.media[1].density).sigma_s->values[0], (Rgb{1, 2, 3}));
  const std::string medium = R"(WorldBegin MakeNamedMedium "g" "string type" )";
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(error_of(text).find(part), std::string::npos) << error_of(text);
  };
  has(medium + R"("uniformgrid" "integer nx" 3 "float density" [1 2])", "needs 3");
  has(medium + R"("uniformgrid" "integer nx" 2000000000 "integer ny" 9 "float density" [1 2])", "2^31");
  has(medium + R"("uniformgrid" "float density" [-1])", "not negative");
  has(medium + R"("homogeneous" "float g" 1)", "between -1 and 1");
  has(medium + R"("smoke")", "unknown medium");
}

TEST(PbrtTextures, ImageMap) {
  const auto scene = read(
      R"(WorldBegin Texture "a" "spectrum" "imagemap" "string filename" "a.png"
Texture "b" "float" "imagemap" "string filename" "/b.png" "string wrap" "clamp" "string filter" "point" "string encoding" "gamma 2.2" "float scale" 2 "bool invert" true "float uscale" 3 "float vscale" 4 "float udelta" 5 "float vdelta" 6)");
  expect_warnings(scene, {});
  const auto& a = std::get<ImageTexture>(scene.spectrum_textures[0].node);
  EXPECT_EQ(a.filename, "scenes/a.png");
  EXPECT_EQ(a.wrap, Wrap::repeat);
  EXPECT_EQ(a.filter, ImageFilter::bilinear);
  EXPECT_EQ(a.encoding, Encoding::automatic);
  EXPECT_EQ(a.scale, 1);
  EXPECT_FALSE(a.invert);
  const auto& b = std::get<ImageTexture>(scene.float_textures[0].node);
  EXPECT_EQ(b.filename, "/b.png");
  EXPECT_EQ(b.wrap, Wrap::clamp);
  EXPECT_EQ(b.filter, ImageFilter::point);
  EXPECT_EQ(b.encoding, Encoding::gamma);
  EXPECT_EQ(b.gamma, 2.2f);
  EXPECT_EQ(b.scale, 2);
  EXPECT_TRUE(b.invert);
  EXPECT_EQ(std::get<UvMapping>(b.mapping).linear, Mat2(3, 0, 0, 4));
  EXPECT_EQ(std::get<UvMapping>(b.mapping).offset, Vec2(5, 6));
}

TEST(PbrtTextures, Combinations) {
  const auto scene = read(
      R"(WorldBegin Texture "c" "spectrum" "constant" "rgb value" [1 2 3] Texture "c" "float" "constant" "float value" .5
Texture "s" "spectrum" "scale" "texture tex" "c" "texture scale" "c"
Texture "m" "float" "mix" "texture tex1" "c" "float amount" .1
Texture "k" "spectrum" "checkerboard" "texture tex1" "s" "float uscale" 8
Translate 1 0 0 Texture "k" "float" "checkerboard" "integer dimension" 3 "float tex2" .25
Material "diffuse" "texture reflectance" "k" Shape "sphere" "texture alpha" "m" Shape "sphere" "float alpha" .5)");
  expect_warnings(scene, {});
  EXPECT_EQ(rgb(std::get<ConstantTexture<SpectrumParameter>>(scene.spectrum_textures[0].node).value.value),
            (Rgb{1, 2, 3}));
  const auto& scaled = std::get<ScaleTexture<SpectrumParameter>>(scene.spectrum_textures[1].node);
  EXPECT_EQ(scaled.tex.texture, 0u);
  EXPECT_EQ(scaled.scale.texture, 0u);
  const auto& mix = std::get<MixTexture<FloatParameter>>(scene.float_textures[1].node);
  EXPECT_EQ(mix.tex1.texture, 0u);
  EXPECT_EQ(mix.tex2.value, 1);
  EXPECT_EQ(mix.amount.value, 0.1f);
  const auto& flat = std::get<Checkerboard<SpectrumParameter>>(scene.spectrum_textures[2].node);
  EXPECT_EQ(flat.tex1.texture, 1u);
  EXPECT_EQ(constant(flat.tex2.value), 0);
  EXPECT_EQ(std::get<UvMapping>(std::get<TextureMapping>(flat.mapping)).linear, Mat2(8, 0, 0, 1));
  const auto& solid = std::get<Checkerboard<FloatParameter>>(scene.float_textures[2].node);
  EXPECT_EQ(solid.tex1.value, 1);
  EXPECT_EQ(solid.tex2.value, 0.25f);
  EXPECT_EQ(std::get<SolidMapping>(solid.mapping).world_to_texture.point({1, 0, 0}), Point(0, 0, 0));
  EXPECT_EQ(std::get<DiffuseMaterial>(scene.materials[1].node).reflectance.texture, 2u);
  EXPECT_EQ(scene.shapes[0].alpha.texture, 1u);
  EXPECT_EQ(scene.shapes[1].alpha.value, 0.5f);
}

TEST(PbrtTextures, Procedural) {
  const auto scene = read(
      R"(WorldBegin Translate 1 2 3
Texture "a" "float" "fbm" Texture "b" "float" "wrinkled" "integer octaves" 3 "float roughness" .7
Texture "c" "float" "windy" Texture "d" "float" "bilerp" "float v10" .25 "float vscale" 2
Texture "e" "float" "dots" "texture inside" "a" "float outside" .5
Rotate 90 0 0 1 Texture "f" "float" "directionmix" "float tex1" .2 "vector3 dir" [0 2 0]
Texture "m" "spectrum" "marble" "float variation" .3 "float scale" 2 "integer octaves" 4
Texture "n" "spectrum" "marble" Texture "x" "spectrum" "directionmix")");
  expect_warnings(scene, {});
  const auto floats = [&](std::size_t i) { return scene.float_textures.at(i).node; };
  const auto fbm = std::get<FbmTexture>(floats(0));
  EXPECT_EQ(fbm.octaves.count, 8);
  EXPECT_EQ(fbm.octaves.roughness, 0.5f);
  EXPECT_EQ(fbm.mapping.world_to_texture.point({1, 2, 3}), Point(0));
  const auto wrinkled = std::get<WrinkledTexture>(floats(1));
  EXPECT_EQ(wrinkled.octaves.count, 3);
  EXPECT_EQ(wrinkled.octaves.roughness, 0.7f);
  EXPECT_EQ(std::get<WindyTexture>(floats(2)).mapping.world_to_texture.point({1, 2, 4}), Point(0, 0, 1));
  const auto bilerp = std::get<BilerpTexture<FloatParameter>>(floats(3));
  EXPECT_EQ(bilerp.v00.value, 0);
  EXPECT_EQ(bilerp.v01.value, 1);
  EXPECT_EQ(bilerp.v10.value, 0.25f);
  EXPECT_EQ(bilerp.v11.value, 1);
  EXPECT_EQ(std::get<UvMapping>(bilerp.mapping).linear, Mat2(1, 0, 0, 2));
  // As in pbrt-v4, where "inside" is the background.
  const auto dots = std::get<DotsTexture<FloatParameter>>(floats(4));
  EXPECT_EQ(dots.outside.texture, 0u);
  EXPECT_EQ(dots.inside.value, 0.5f);
  const auto direction = std::get<DirectionMixTexture<FloatParameter>>(floats(5));
  EXPECT_EQ(direction.tex1.value, 0.2f);
  EXPECT_EQ(direction.tex2.value, 1);
  EXPECT_NEAR(direction.direction.x, -1, 1e-6f);
  EXPECT_NEAR(direction.direction.y, 0, 1e-6f);
  const auto marble = std::get<MarbleTexture>(scene.spectrum_textures.at(0).node);
  EXPECT_EQ(marble.variation, 0.3f);
  EXPECT_EQ(marble.scale, 2);
  EXPECT_EQ(marble.octaves.count, 4);
  EXPECT_EQ(std::get<MarbleTexture>(scene.spectrum_textures.at(1).node).variation, 0.2f);
}

TEST(PbrtTextures, Mappings) {
  const auto scene = read(
      R"(WorldBegin Translate 0 0 5 Texture "s" "float" "dots" "string mapping" "spherical"
Texture "c" "float" "bilerp" "string mapping" "cylindrical"
Texture "p" "float" "imagemap" "string filename" "x" "string mapping" "planar" "vector3 v1" [2 0 0] "vector3 v2" [0 0 3] "float udelta" .5 "float vdelta" .25 "string filter" "ewa" "string wrap" "octahedralsphere" "float maxanisotropy" 4
Texture "q" "float" "imagemap" "string filename" "x" "string filter" "trilinear")");
  expect_warnings(scene, {});
  const auto& sphere = std::get<DotsTexture<FloatParameter>>(scene.float_textures[0].node).mapping;
  EXPECT_EQ(std::get<SphericalTextureMapping>(sphere).world_to_texture.point({0, 0, 5}), Point(0));
  const auto& cylinder = std::get<BilerpTexture<FloatParameter>>(scene.float_textures[1].node).mapping;
  EXPECT_EQ(std::get<CylindricalTextureMapping>(cylinder).world_to_texture.point({0, 0, 5}), Point(0));
  const auto& image = std::get<ImageTexture>(scene.float_textures[2].node);
  const auto& plane = std::get<PlanarTextureMapping>(image.mapping);
  EXPECT_EQ(plane.v1, Vec3(2, 0, 0));
  EXPECT_EQ(plane.v2, Vec3(0, 0, 3));
  EXPECT_EQ(plane.offset, Vec2(0.5f, 0.25f));
  EXPECT_EQ(image.wrap, Wrap::octahedral_sphere);
  EXPECT_EQ(image.filter, ImageFilter::bilinear);
  EXPECT_EQ(std::get<ImageTexture>(scene.float_textures[3].node).filter, ImageFilter::bilinear);
}

TEST(PbrtTextures, SubstitutesAreNamed) {
  const auto scene =
      read(R"(WorldBegin Texture "a" "spectrum" "ptex" "string filename" "a.ptx" Texture "b" "float" "ptex")");
  expect_warnings(scene, {R"(texture "ptex" is not supported: replaced by the constant 0.5 (and 1 more like it))"});
  EXPECT_EQ(std::get<ConstantTexture<FloatParameter>>(scene.float_textures[0].node).value.value, 0.5f);
}

TEST(PbrtMaterials, Relief) {
  const auto scene = read(
      R"(WorldBegin Texture "d" "float" "fbm" Material "diffuse" "texture displacement" "d" Shape "sphere"
Material "dielectric" "string normalmap" "n.png" Shape "sphere"
Material "conductor" "string normalmap" "/n.png" "texture displacement" "d" Shape "sphere"
MakeNamedMaterial "a" "string type" "diffuse"
Material "mix" "string materials" ["a" "a"] "texture displacement" "d" Shape "sphere")");
  expect_warnings(scene, {R"(a material has both "normalmap" and "displacement": the displacement is ignored)",
                          R"(parameter "displacement" of Material "mix" is not used by Lanthorn: ignored)"});
  const auto& bumps = scene.materials.at(scene.shapes[0].material);
  EXPECT_EQ(bumps.displacement->texture, 0u);
  EXPECT_FALSE(bumps.normal_map.has_value());
  const auto& mapped = scene.materials.at(scene.shapes[1].material);
  EXPECT_FALSE(mapped.displacement.has_value());
  EXPECT_EQ(mapped.normal_map->image.filename, "scenes/n.png");
  EXPECT_EQ(mapped.normal_map->image.encoding, Encoding::linear);
  EXPECT_EQ(mapped.normal_map->strength, 1);
  EXPECT_EQ(scene.materials.at(scene.shapes[2].material).normal_map->image.filename, "/n.png");
  EXPECT_FALSE(scene.materials.at(scene.shapes[3].material).displacement.has_value());
}

TEST(PbrtTextures, Errors) {
  const std::string start = R"(WorldBegin Texture "t" "float" "imagemap" "string filename" "a" )";
  EXPECT_EQ(error_of(start + R"("string wrap" "mirror")"),
            R"(t.pbrt:1:65: parameter "wrap" of Texture "imagemap" must be repeat, black, clamp or octahedralsphere, )"
            R"(not "mirror")");
  EXPECT_EQ(error_of(start + R"("string encoding" "gamma x")"),
            R"(t.pbrt:1:65: parameter "encoding" of Texture "imagemap" needs a positive number after "gamma")");
  EXPECT_EQ(error_of(R"(WorldBegin Texture "t" "float" "scale" "texture tex" "t")"),
            R"(t.pbrt:1:40: parameter "tex" of Texture "scale" names the float texture "t", which is not defined)");
  EXPECT_EQ(error_of(R"(WorldBegin Texture "t" "spectrum" "fbm")"),
            R"(t.pbrt:1:12: texture "fbm" must be of type float)");
  EXPECT_EQ(error_of(R"(WorldBegin Texture "t" "float" "marble")"),
            R"(t.pbrt:1:12: texture "marble" must be of type spectrum)");
  for (const char* octaves : {"0", "25", "-3"})
    EXPECT_EQ(error_of(std::string(R"(WorldBegin Texture "t" "float" "fbm" "integer octaves" )") + octaves),
              R"(t.pbrt:1:38: parameter "octaves" of Texture "fbm" must be from 1 to 24)");
  EXPECT_EQ(error_of(R"(WorldBegin
Texture "t" "float" "directionmix" "vector3 dir" [0 0 0])"),
            R"(t.pbrt:2:36: parameter "dir" of Texture "directionmix" must not be zero)");
  EXPECT_EQ(error_of(R"(WorldBegin Texture "t" "float" "dots" "string mapping" "cubic")"),
            R"(t.pbrt:1:39: parameter "mapping" of Texture "dots" must be uv, spherical, cylindrical or planar, not )"
            R"("cubic")");
  EXPECT_EQ(error_of(R"(WorldBegin Material "diffuse" "texture displacement" "d" Shape "sphere")"),
            R"(t.pbrt:1:31: parameter "displacement" of Material "diffuse" names the float texture "d", which is not )"
            "defined");
}

TEST(PbrtLights, DefaultsAndParameters) {
  const auto scene = read(
      R"(WorldBegin LightSource "point" LightSource "spot" LightSource "distant" LightSource "infinite"
LightSource "point" "blackbody I" 3000 "float scale" 2 "float power" 100 "point3 from" [1 2 3]
LightSource "spot" "float coneangle" 20 "float conedeltaangle" 3 "float power" -1
LightSource "distant" "rgb L" [1 2 3] "point3 from" [0 1 0] "point3 to" [0 0 0] "float illuminance" 5 "float angle" .53
Rotate -90 1 0 0 LightSource "infinite" "string filename" "sky.pfm" "float illuminance" 7)");
  expect_warnings(scene, {});
  const auto& point = std::get<PointLight>(scene.lights[0].node);
  EXPECT_EQ(rgb(point.intensity.spectrum), (Rgb{1, 1, 1}));
  EXPECT_EQ(point.intensity.scale, 1);
  EXPECT_FALSE(point.power.has_value());
  const auto& spot = std::get<SpotLight>(scene.lights[1].node);
  EXPECT_EQ(spot.cone_angle, 30);
  EXPECT_EQ(spot.cone_delta_angle, 5);
  EXPECT_EQ(spot.to, Point(0, 0, 1));
  const auto& distant = std::get<DistantLight>(scene.lights[2].node);
  EXPECT_EQ(distant.from, Point(0, 0, 0));
  EXPECT_EQ(distant.to, Point(0, 0, 1));
  EXPECT_FALSE(std::get<InfiniteLight>(scene.lights[3].node).image.has_value());
  const auto& warm = std::get<PointLight>(scene.lights[4].node);
  EXPECT_EQ(std::get<BlackbodySpectrum>(warm.intensity.spectrum).kelvin, 3000);
  EXPECT_EQ(warm.intensity.scale, 2);
  EXPECT_EQ(warm.power, 100);
  EXPECT_EQ(warm.from, Point(1, 2, 3));
  EXPECT_EQ(std::get<SpotLight>(scene.lights[5].node).cone_angle, 20);
  EXPECT_EQ(std::get<SpotLight>(scene.lights[5].node).cone_delta_angle, 3);
  EXPECT_FALSE(std::get<SpotLight>(scene.lights[5].node).power.has_value());
  EXPECT_EQ(distant.angle, 0);
  EXPECT_EQ(std::get<DistantLight>(scene.lights[6].node).illuminance, 5);
  EXPECT_EQ(std::get<DistantLight>(scene.lights[6].node).angle, .53f);
  const auto& sky = std::get<InfiniteLight>(scene.lights[7].node);
  EXPECT_EQ(sky.image, "scenes/sky.pfm");
  EXPECT_EQ(sky.illuminance, 7);
  EXPECT_NEAR(scene.lights[7].light_to_world.vector({0, 0, 1}).y, 1, 1e-6);
}

// A cone narrower than the default width of its edge is valid.
TEST(PbrtLights, EdgesWiderThanTheConeOfASpot) {
  const auto scene = read(
      R"(WorldBegin LightSource "spot" "float coneangle" 4
LightSource "spot" "float coneangle" 1
LightSource "spot" "float coneangle" 8 "float conedeltaangle" 8)");
  expect_warnings(scene, {});
  const auto delta = [&](std::size_t i) { return std::get<SpotLight>(scene.lights[i].node).cone_delta_angle; };
  EXPECT_EQ(delta(0), 3);  // from 1 degree, since cos(4 - 5) = cos 1
  EXPECT_EQ(delta(1), 0);  // would begin at 4 degrees
  EXPECT_EQ(delta(2), 8);
  EXPECT_EQ(error_of(R"(WorldBegin LightSource "spot" "float conedeltaangle" -1)"),
            R"(t.pbrt:1:31: parameter "conedeltaangle" of LightSource "spot" must not be negative)");
}

TEST(PbrtLights, AreaLights) {
  const auto scene = read(
      R"(WorldBegin AreaLightSource "diffuse" Shape "sphere" Shape "disk"
AreaLightSource "diffuse" "rgb L" [1 2 3] "float scale" 4 "bool twosided" true "float power" 60 Shape "sphere"
Material "interface" Shape "sphere" Shape "sphere")");
  ASSERT_EQ(scene.area_lights.size(), 2u);
  EXPECT_EQ(rgb(scene.area_lights[0].radiance.value), (Rgb{1, 1, 1}));
  EXPECT_FALSE(scene.area_lights[0].two_sided);
  EXPECT_EQ(scene.area_lights[1].scale, 4);
  EXPECT_TRUE(scene.area_lights[1].two_sided);
  EXPECT_EQ(scene.area_lights[1].power, 60);
  EXPECT_EQ(scene.shapes[0].area_light, 0u);
  EXPECT_EQ(scene.shapes[1].area_light, 0u);
  EXPECT_EQ(scene.shapes[2].area_light, 1u);
  EXPECT_FALSE(scene.shapes[3].area_light.has_value());
  expect_warnings(
      scene, {R"(a shape of material "interface" cannot emit light: its emission is ignored (and 1 more like it))"});
}

TEST(PbrtLights, LightsWithImages) {
  const auto scene = read(
      R"(WorldBegin LightSource "goniometric" "string filename" "g.exr" "rgb I" [1 2 3] "float power" 9
LightSource "projection" "string filename" "p.exr" "float fov" 40 "float scale" 2
Translate 5 0 0 LightSource "infinite" "string filename" "s.exr" "point3 portal" [0 0 0 1 0 0 1 1 0 0 1 0]
AreaLightSource "diffuse" "string filename" "a.png" Shape "sphere"
Texture "t" "spectrum" "checkerboard" AreaLightSource "diffuse" "texture L" "t" Shape "sphere")");
  expect_warnings(scene, {});
  ASSERT_EQ(scene.lights.size(), 3u);
  const auto& lamp = std::get<GoniometricLight>(scene.lights[0].node);
  EXPECT_EQ(rgb(lamp.intensity.spectrum), (Rgb{1, 2, 3}));
  EXPECT_EQ(lamp.image, "scenes/g.exr");
  EXPECT_EQ(lamp.power, 9);
  EXPECT_EQ(scene.lights[0].light_to_world.vector({0, 0, 1}), Vec3(0, 1, 0));
  EXPECT_EQ(scene.lights[0].light_to_world.vector({1, 0, 0}), Vec3(1, 0, 0));
  const auto& projector = std::get<ProjectionLight>(scene.lights[1].node);
  EXPECT_EQ(projector.image, "scenes/p.exr");
  EXPECT_EQ(projector.fov, 40);
  EXPECT_EQ(projector.scale, 2);
  EXPECT_FALSE(projector.power.has_value());
  const auto& window = std::get<InfiniteLight>(scene.lights[2].node);
  ASSERT_TRUE(window.portal.has_value());
  EXPECT_EQ((*window.portal)[2], Point(1, 1, 0));  // in the world, not moved by the Translate
  ASSERT_EQ(scene.area_lights.size(), 2u);
  const auto& image =
      std::get<ImageTexture>(scene.spectrum_textures.at(scene.area_lights[0].radiance.texture.value()).node);
  EXPECT_EQ(image.filename, "scenes/a.png");
  EXPECT_EQ(image.wrap, Wrap::clamp);
  EXPECT_EQ(scene.area_lights[1].radiance.texture, 1u);
}

TEST(PbrtLights, Errors) {
  EXPECT_EQ(error_of(R"(WorldBegin LightSource "infinite" "rgb L" [1 1 1] "string filename" "a")"),
            R"(t.pbrt:1:51: parameter "filename" of LightSource "infinite" cannot be given together with "L")");
  EXPECT_EQ(error_of(R"(WorldBegin LightSource "spot" "point3 to" [0 0 0])"),
            R"(t.pbrt:1:12: parameter "from" of LightSource "spot" is the same point as "to")");
  EXPECT_EQ(error_of(R"(WorldBegin LightSource "spot" "float coneangle" 0)"),
            R"(t.pbrt:1:31: parameter "coneangle" of LightSource "spot" must be in (0, 180] degrees)");
  EXPECT_EQ(error_of(R"(WorldBegin LightSource "distant" "float angle" 180)"),
            R"(t.pbrt:1:34: parameter "angle" of LightSource "distant" must be in [0, 180) degrees)");
  EXPECT_EQ(error_of(R"(WorldBegin LightSource "projection")"),
            R"(t.pbrt:1:12: parameter "filename" of LightSource "projection" is missing)");
  EXPECT_EQ(error_of(R"(WorldBegin LightSource "goniometric")"),
            R"(t.pbrt:1:12: parameter "filename" of LightSource "goniometric" is missing)");
  EXPECT_EQ(error_of(R"(WorldBegin LightSource "projection" "string filename" "a" "float fov" 180)"),
            R"(t.pbrt:1:59: parameter "fov" of LightSource "projection" must be between 0 and 180 degrees)");
  EXPECT_EQ(error_of(R"(WorldBegin LightSource "infinite" "point3 portal" [0 0 0 1 0 0 1 1 0])"),
            R"(t.pbrt:1:35: parameter "portal" of LightSource "infinite" needs four points, has 3)");
  for (const char* const skewed : {"0 0 0 1 0 0 2 1 0 1 1 0", "0 0 0 1 0 0 1 1 1 0 1 0", "0 0 0 1 0 0 1 0 0 0 0 0"})
    EXPECT_EQ(error_of(R"(WorldBegin LightSource "infinite" "point3 portal" [)" + std::string(skewed) + "]"),
              R"(t.pbrt:1:35: parameter "portal" of LightSource "infinite" must go around the corners of a rectangle)");
  EXPECT_EQ(error_of(R"(WorldBegin AreaLightSource "diffuse" "rgb L" [1 1 1] "string filename" "a")"),
            R"(t.pbrt:1:54: parameter "filename" of AreaLightSource "diffuse" cannot be given together with "L")");
}

TEST(PbrtShapes, Quadrics) {
  const auto scene = read(
      R"(WorldBegin Shape "sphere" Shape "sphere" "float radius" 2 "float zmin" -1 "float zmax" .5 "float phimax" 90
Shape "disk" Shape "disk" "float height" 1 "float radius" 2 "float innerradius" .5 "float phimax" 720
Shape "cylinder" Shape "cylinder" "float radius" 2 "float zmin" 4 "float zmax" -3)");
  expect_warnings(scene, {});
  const auto& ball = std::get<Sphere>(scene.shapes[0].geometry);
  EXPECT_EQ(ball.radius, 1);
  EXPECT_EQ(ball.z_min, -1);
  EXPECT_EQ(ball.z_max, 1);
  EXPECT_EQ(ball.phi_max, 360);
  const auto& slice = std::get<Sphere>(scene.shapes[1].geometry);
  EXPECT_EQ(slice.z_min, -1);
  EXPECT_EQ(slice.z_max, 0.5f);
  EXPECT_EQ(slice.phi_max, 90);
  EXPECT_EQ(std::get<Disk>(scene.shapes[2].geometry).height, 0);
  EXPECT_EQ(std::get<Disk>(scene.shapes[3].geometry).inner_radius, 0.5f);
  EXPECT_EQ(std::get<Disk>(scene.shapes[3].geometry).phi_max, 360);
  EXPECT_EQ(std::get<Cylinder>(scene.shapes[4].geometry).z_min, -1);
  EXPECT_EQ(std::get<Cylinder>(scene.shapes[5].geometry).z_min, -3);
  EXPECT_EQ(std::get<Cylinder>(scene.shapes[5].geometry).z_max, 4);
}

TEST(PbrtShapes, Meshes) {
  const auto scene = read(
      R"(WorldBegin Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0] "normal N" [0 0 1 0 0 1 0 0 1 0 0 1] "string emissionfilename" "e.png"
Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0] "integer indices" [0 1 2 2 1 3] "integer faceIndices" [0 1]
Shape "loopsubdiv" "integer levels" 3 "integer indices" [0 1 2] "point3 P" [0 0 0 1 0 0 0 1 0])");
  const auto& patch = std::get<BilinearMesh>(scene.shapes[0].geometry);
  EXPECT_EQ(patch.patches, (std::vector<std::array<std::uint32_t, 4>>{{0, 1, 2, 3}}));
  EXPECT_EQ(patch.normals.size(), 4u);
  EXPECT_EQ(std::get<TriangleMesh>(scene.shapes[1].geometry).triangles[1], (std::array<std::uint32_t, 3>{2, 1, 3}));
  EXPECT_EQ(std::get<TriangleMesh>(scene.shapes[2].geometry).triangles.size(), 64u);
  expect_warnings(scene, {});
}

TEST(PbrtShapes, PlyFilesGiveOneOrTwoShapes) {
  const test::TemporaryDir dir;
  const std::string start =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face ";
  const std::string rest = "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  dir.write("m/both.ply", start + "2" + rest + "3 0 1 2\n4 0 1 2 3\n");
  dir.write("m/quad.ply", start + "1" + rest + "4 0 1 2 3\n");
  dir.write("m/none.ply", start + "0" + rest);
  dir.write("m/bad.ply", start + "1" + rest + "3 0 1 9\n");
  const auto path = dir.write(
      "s.pbrt",
      R"(WorldBegin Shape "plymesh" "string filename" "m/both.ply" "float alpha" .5 Shape "plymesh" "string filename" "m/none.ply"
Shape "sphere" Shape "plymesh" "string filename" "m/quad.ply" "texture displacement" "d" "float edgelength" 2
Texture "d" "float" "constant" "float value" 1
ObjectBegin "o" Shape "plymesh" "string filename" "m/both.ply" ObjectEnd)");
  const SceneDescription scene = read_scene(path);
  ASSERT_EQ(scene.shapes.size(), 4u);
  EXPECT_EQ(std::get<TriangleMesh>(scene.shapes[0].geometry).triangles.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<Sphere>(scene.shapes[1].geometry));
  EXPECT_EQ(std::get<BilinearMesh>(scene.shapes[2].geometry).patches.size(), 1u);
  EXPECT_EQ(std::get<BilinearMesh>(scene.shapes[3].geometry).patches.size(), 1u);
  EXPECT_EQ(scene.shapes[3].alpha.value, 0.5f);
  EXPECT_EQ(scene.objects[0].shapes.size(), 2u);
  ASSERT_TRUE(scene.shapes[2].displacement);
  EXPECT_EQ(scene.shapes[2].displacement->height.texture, 0u);
  EXPECT_EQ(scene.shapes[2].displacement->edge_length, 2);
  expect_warnings(scene, {(dir.path() / "m/none.ply").string() + ": the mesh has no faces: left out"});
  EXPECT_THROW(read_pbrt_string(R"(WorldBegin Shape "plymesh" "string filename" "m/bad.ply")", dir.path(), "s"), Error);
}

TEST(PbrtMedia, InterfacesAreKept) {
  const auto scene = read(
      R"(WorldBegin MakeNamedMedium "fog" "string type" "homogeneous" "float g" .3 MediumInterface "fog" "" Shape "sphere"
MediumInterface "fog" Shape "sphere")");
  EXPECT_EQ(scene.shapes[0].inside_medium, 0u);
  EXPECT_EQ(scene.shapes[0].outside_medium, std::nullopt);
  EXPECT_EQ(scene.shapes[1].outside_medium, 0u);
  EXPECT_EQ(scene.media[0].name, "fog");
  EXPECT_EQ(scene.media[0].g, 0.3f);
  expect_warnings(scene, {});
}

TEST(PbrtCamera, Kinds) {
  const auto scene =
      read(R"(Camera "perspective" "float fov" 40 "float lensradius" .1 "float focaldistance" 3 "float shutteropen" )"
           R"(.25 "float )"
           R"(shutterclose" .75 "float frameaspectratio" 2 "float screenwindow" [-1 1 -2 2] Film "rgb" "float iso" )"
           "200 WorldBegin");
  expect_warnings(scene, {});
  const auto& camera = std::get<PerspectiveCamera>(scene.view.camera.node);
  EXPECT_EQ(camera.fov, 40);
  EXPECT_EQ(camera.lens_radius, 0.1f);
  EXPECT_EQ(camera.focal_distance, 3);
  EXPECT_EQ(scene.view.camera.shutter_open, 0.25f);
  EXPECT_EQ(scene.view.camera.shutter_close, 0.75f);
  EXPECT_EQ(scene.view.camera.frame_aspect_ratio, 2);
  EXPECT_EQ(scene.view.camera.screen_window, (std::array<float, 4>{-1, 1, -2, 2}));
  EXPECT_EQ(scene.view.film.imaging_ratio, 1) << "half a second at twice the speed";
  const auto defaults = std::get<PerspectiveCamera>(read("WorldBegin").view.camera.node);
  EXPECT_EQ(defaults.fov, 90);
  EXPECT_EQ(defaults.lens_radius, 0);
  EXPECT_EQ(defaults.focal_distance, 1e6f);
  EXPECT_TRUE(std::holds_alternative<OrthographicCamera>(read(R"(Camera "orthographic" WorldBegin)").view.camera.node));
  const auto sphere = [](const std::string& mapping) {
    return std::get<SphericalCamera>(read(R"(Camera "spherical")" + mapping + " WorldBegin").view.camera.node).mapping;
  };
  EXPECT_EQ(sphere(""), SphericalMapping::equal_area);
  EXPECT_EQ(sphere(R"( "string mapping" "equirectangular")"), SphericalMapping::equirectangular);
}

TEST(PbrtFilm, SizeAndCrop) {
  const Film defaults = read("WorldBegin").view.film;
  EXPECT_EQ(defaults.width, 1280);
  EXPECT_EQ(defaults.height, 720);
  EXPECT_EQ(defaults.imaging_ratio, 1);
  const Film film =
      read(R"(Film "rgb" "integer xresolution" 10 "integer yresolution" 30 "string filename" "a.exr" "float )"
           R"(cropwindow" [.75 .25 0 2] WorldBegin)")
          .view.film;
  EXPECT_EQ(film.width, 10);
  EXPECT_EQ(film.height, 30);
  EXPECT_EQ(film.filename, "a.exr");
  EXPECT_EQ(film.crop, (std::array<float, 4>{0.25f, 0.75f, 0, 1}));
  const Film bounds =
      read(R"(Film "rgb" "integer xresolution" 10 "integer yresolution" 30 "integer pixelbounds" [3 7 0 29] )"
           "WorldBegin")
          .view.film;
  const std::array<float, 4> size{10, 10, 30, 30}, expected{3, 7, 0, 29};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(std::ceil(bounds.crop[i] * size[i]), expected[i]) << i;
  EXPECT_EQ(error_of(R"(Film "rgb" "float cropwindow" [.5 .5 0 1] WorldBegin)"),
            R"(t.pbrt:1:12: parameter "cropwindow" of Film "rgb" leaves no pixel)");
  EXPECT_EQ(error_of(R"(Film "rgb" "integer xresolution" 0 WorldBegin)"),
            R"(t.pbrt:1:12: parameter "xresolution" of Film "rgb" must be between 1 and 65536)");
}

TEST(PbrtFilm, SubstitutesAreNamed) {
  const auto scene =
      read(R"(Film "gbuffer" "string sensor" "canon_eos_5d" "float whitebalance" 5000 "float maxcomponentvalue" 10 )"
           R"("float diagonal" )"
           R"(35 "bool savefp16" false WorldBegin)");
  expect_warnings(scene, {R"(the measured sensor "canon_eos_5d" is not supported: replaced by "cie1931")"});
  EXPECT_EQ(scene.view.film.white_balance, 5000);
  EXPECT_EQ(scene.view.film.largest_component, 10);
  EXPECT_EQ(error_of(R"(Film "rgb" "float whitebalance" 10 WorldBegin)"),
            R"(t.pbrt:1:12: parameter "whitebalance" of Film "rgb" must be 0 or from 1000 to 25000 kelvin)");
  EXPECT_EQ(error_of(R"(Film "rgb" "float maxcomponentvalue" 0 WorldBegin)"),
            R"(t.pbrt:1:12: parameter "maxcomponentvalue" of Film "rgb" must be above 0)");
}

TEST(PbrtFilm, SpectralOnesHaveBuckets) {
  EXPECT_FALSE(read(R"(Film "rgb" WorldBegin)").view.film.buckets);
  const auto plain = read(R"(Film "spectral" WorldBegin)");
  expect_warnings(plain, {});
  EXPECT_EQ(plain.view.film.buckets, (SpectralBuckets{16, 360, 830}));
  const auto given =
      read(R"(Film "spectral" "integer nbuckets" 3 "float lambdamin" 400 "float lambdamax" 700 WorldBegin)");
  expect_warnings(given, {});
  EXPECT_EQ(given.view.film.buckets, (SpectralBuckets{3, 400, 700}));
  EXPECT_EQ(given.view.film.buckets->centre(1), 550);
  EXPECT_EQ(given.view.film.buckets->find(499), 0u);
  EXPECT_EQ(given.view.film.buckets->find(700), 2u);
  EXPECT_FALSE(given.view.film.buckets->find(701));
  const auto message = [](const char* parameter) {
    return error_of(R"(Film "spectral" )" + std::string(parameter) + " WorldBegin");
  };
  EXPECT_EQ(message(R"("integer nbuckets" 0)"),
            R"(t.pbrt:1:17: parameter "nbuckets" of Film "spectral" must be between 1 and 512)");
  EXPECT_EQ(message(R"("float lambdamin" 300)"),
            R"(t.pbrt:1:17: parameter "lambdamin" of Film "spectral" must be at least 360)");
  EXPECT_EQ(message(R"("float lambdamax" 831)"),
            R"(t.pbrt:1:17: parameter "lambdamax" of Film "spectral" must be at most 830)");
  EXPECT_EQ(message(R"("float lambdamax" 360)"),
            R"(t.pbrt:1:17: parameter "lambdamax" of Film "spectral" must be larger than "lambdamin" by 1 or more)");
}

TEST(PbrtFilter, KindsAndDefaults) {
  const auto filter = [](const std::string& text) { return read(text + " WorldBegin").view.filter; };
  EXPECT_EQ(filter("").kind, FilterKind::gaussian);
  EXPECT_EQ(filter("").radius, Vec2(1.5f, 1.5f));
  EXPECT_EQ(filter("").sigma, 0.5f);
  EXPECT_EQ(filter(R"(PixelFilter "box")").radius, Vec2(0.5f, 0.5f));
  EXPECT_EQ(filter(R"(PixelFilter "triangle")").radius, Vec2(2, 2));
  EXPECT_EQ(filter(R"(PixelFilter "gaussian" "float sigma" .7)").sigma, 0.7f);
  const Filter mitchell = filter(R"(PixelFilter "mitchell" "float B" .5 "float xradius" 3)");
  EXPECT_EQ(mitchell.radius, Vec2(3, 2));
  EXPECT_EQ(mitchell.b, 0.5f);
  EXPECT_EQ(mitchell.c, 1.0f / 3);
  EXPECT_EQ(filter(R"(PixelFilter "sinc")").radius, Vec2(4, 4));
  EXPECT_EQ(filter(R"(PixelFilter "sinc")").tau, 3);
  EXPECT_EQ(error_of(R"(PixelFilter "box" "float xradius" 0)"),
            R"(t.pbrt:1:19: parameter "xradius" of PixelFilter "box" must be above 0)");
}

TEST(PbrtHints, IntegratorAndSampler) {
  const auto hints =
      read(R"(Integrator "sppm" "integer maxdepth" 9 "integer photonsperiteration" 1000 "float radius" .01 )"
           R"("integer seed" 3 Sampler "halton" "integer pixelsamples" 32 Accelerator "kdtree" "integer x" 1 )"
           "WorldBegin")
          .hints;
  EXPECT_EQ(hints.integrator, "sppm");
  EXPECT_EQ(hints.max_depth, 9);
  EXPECT_EQ(hints.photons_per_iteration, 1000);
  EXPECT_EQ(hints.parameters, (std::map<std::string, std::string>{{"radius", "0.01"}}));
  EXPECT_EQ(hints.seed, 3u);
  EXPECT_EQ(hints.pixel_samples, 32);
  EXPECT_EQ(read(R"(Option "seed" 5 WorldBegin)").hints.seed, 5u);
  EXPECT_EQ(read(R"(Sampler "stratified" "integer xsamples" 3 WorldBegin)").hints.pixel_samples, 12);
  EXPECT_EQ(read(R"(Integrator "sppm" "integer photonsperiteration" -1 WorldBegin)").hints.photons_per_iteration,
            std::nullopt);
  const auto none = read("WorldBegin").hints;
  EXPECT_EQ(none.integrator, "");
  EXPECT_FALSE(none.max_depth || none.pixel_samples || none.seed || !none.parameters.empty() ||
               none.photons_per_iteration);
}

TEST(PbrtHints, MethodsOfLanthornHaveTheirParameters) {
  const SceneDescription scene =
      read(R"(Integrator "photonmap" "integer gather" 8 "string max-radius" "auto" WorldBegin)");
  EXPECT_EQ(scene.hints.integrator, "photonmap");
  EXPECT_EQ(scene.hints.parameters, (std::map<std::string, std::string>{{"gather", "8"}, {"max-radius", "auto"}}));
  EXPECT_TRUE(scene.warnings.empty());
  const std::string bad = test::error_text([] { read(R"(Integrator "photonmap" "integer gather" 0 WorldBegin)"); });
  EXPECT_TRUE(bad.starts_with("t.pbrt:1:1: ") && bad.find("gather") != bad.npos) << bad;
}

TEST(PbrtHints, UnknownIntegratorsAreNamed) {
  const SceneDescription scene = read(R"(Integrator "radiosity" WorldBegin)");
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0].message,
            R"(neither pbrt nor Lanthorn has an integrator "radiosity": the default method is used)");
}

}  // namespace
}  // namespace lanthorn::pbrt_entities_test
