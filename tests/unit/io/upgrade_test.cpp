// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Translation of pbrt-v3 files: pictures against those of the same scenes written for pbrt-v4, albedos against
// pbrt-v3's sums of lobes, and rules of translation that pictures do not show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "lanthorn/scene.h"
#include "support/error_text.h"
#include "support/runs.h"
#include "support/temporary_dir.h"

namespace lanthorn::upgrade_test {
namespace {

SceneDescription read(const std::string& text) { return read_pbrt_string(text, ".", "t.pbrt"); }

std::string error_of(const std::string& text) {
  return test::error_text([&] { read(text); });
}

std::vector<std::string> warnings_of(const std::string& text) {
  std::vector<std::string> result;
  for (const description::Warning& w : read(text).warnings)
    result.push_back(std::to_string(w.location.line) + " " + w.message);
  return result;
}

const std::string v3_head = R"(Film "image" "integer xresolution" 24 "integer yresolution" 24
)";

// The headers are for different versions, and describe the same film.
struct Pair {
  std::string name;
  std::string v3_options, v4_options;
  std::string v3, v4;
  std::string v4_film = {};
};

const std::string camera = R"(LookAt 0 1.5 5  0 0.3 0  0 1 0
Camera "perspective" "float fov" 40
)";
const std::string room =
    R"(LightSource "distant" "point3 from" [1 3 2] "point3 to" [0 0 0]
Shape "disk" "float radius" 4 "float height" 0
)";

std::string v3_text(const Pair& p) {
  return camera + p.v3_options +
         R"(Film "image" "integer xresolution" [32] "integer yresolution" [24]
PixelFilter "box" "float xwidth" [0.5] "float ywidth" [0.5]
WorldBegin
)" + p.v3 +
         "WorldEnd\n";
}

std::string v4_text(const Pair& p) {
  return camera + p.v4_options + R"(Film "rgb" "integer xresolution" [32] "integer yresolution" [24] )" + p.v4_film +
         R"(
PixelFilter "box" "float xradius" [0.5] "float yradius" [0.5]
WorldBegin
)" + p.v4;
}

// Numbers that only the v4 text contains were computed independently: GGX alpha by pbrt-v3's polynomial, luminances of
// black bodies from Planck's law and the CIE's table.
std::vector<Pair> pairs() {
  const std::string sky3 = R"(LightSource "infinite" "color L" [.5 .6 .7] "color scale" [2 2 2]
)";
  const std::string sky4 = R"(LightSource "infinite" "rgb L" [.5 .6 .7] "float scale" 2
)";
  const std::string ball = R"(Translate 0 .5 0
Shape "sphere" "float radius" .8
)";
  return {
      {"matte and a lamp", "", "",
       R"(AttributeBegin
AreaLightSource "area" "color L" [8 7 6] "color scale" [.5 .5 .5] "integer nsamples" 4
Translate 0 3 0
Shape "sphere" "float radius" .5
AttributeEnd
MakeNamedMaterial "red" "string type" "matte" "color Kd" [.8 .1 .1]
NamedMaterial "red"
)" + ball,
       R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [8 7 6] "float scale" .5
Translate 0 3 0
Shape "sphere" "float radius" .5
AttributeEnd
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [.8 .1 .1]
NamedMaterial "red"
)" + ball},
      {"plastic", "", "", sky3 + R"(Material "plastic" "rgb Kd" [.5 .4 .1] "rgb Ks" [.5 .5 .5] "float roughness" .1
)" + ball,
       sky4 +
           R"(MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [1 .8 .2]
MakeNamedMaterial "b" "string type" "coateddiffuse" "rgb reflectance" [0 0 0]
 "float roughness" .461760 "bool remaproughness" false
Material "mix" "string materials" ["a" "b"] "float amount" .5
)" + ball},
      {"metal and mirror", "", "",
       sky3 +
           R"(Material "mirror" "color Kr" [.7 .8 .9]
Shape "disk" "float radius" 3
Material "metal" "rgb eta" [.2 .9 1.1] "rgb k" [3.9 2.5 2.2] "float uroughness" .05 "float vroughness" .2
)" + ball,
       sky4 +
           R"(Material "conductor" "rgb reflectance" [.7 .8 .9]
Shape "disk" "float radius" 3
Material "conductor" "rgb eta" [.2 .9 1.1] "rgb k" [3.9 2.5 2.2] "bool remaproughness" false
 "float uroughness" .312547 "float vroughness" .683836
)" + ball},
      {"glass", R"(Integrator "sppm" "integer numiterations" 3
)",
       R"(Integrator "sppm"
Sampler "halton" "integer pixelsamples" 3
)",
       sky3 + R"(Material "glass" "float index" 1.7
)" + ball,
       sky4 + R"(Material "dielectric" "float eta" 1.7
)" + ball},
      {"textures", "", "",
       sky3 +
           R"(Texture "a" "color" "checkerboard" "color tex1" [.9 .1 .1] "color tex2" [.1 .9 .1] "string aamode" "none"
Texture "b" "color" "scale" "texture tex1" "a" "color tex2" [.5 .5 .5]
AttributeBegin
Texture "a" "color" "fbm"
Material "matte" "texture Kd" "a"
Shape "disk" "float radius" 3
AttributeEnd
Material "matte" "texture Kd" "b"
)" + ball,
       sky4 +
           R"(Texture "a" "spectrum" "checkerboard" "rgb tex1" [.9 .1 .1] "rgb tex2" [.1 .9 .1]
Texture "b" "spectrum" "scale" "texture tex" "a" "float scale" .5
AttributeBegin
Texture "f" "float" "fbm"
Texture "c" "spectrum" "mix" "float tex1" 0 "float tex2" 1 "texture amount" "f"
Material "diffuse" "texture reflectance" "c"
Shape "disk" "float radius" 3
AttributeEnd
Material "diffuse" "texture reflectance" "b"
)" + ball},
      {"black body and filter", "", "",
       R"(LightSource "point" "blackbody I" [3000 20] "point from" [1 3 2]
Material "matte"
)" + ball,
       R"(LightSource "point" "blackbody I" 3000 "float scale" 8.320374 "point3 from" [1 3 2]
Material "diffuse"
)" + ball},
      {"transforms and overrides", "", "", sky3 + R"(Material "matte" "color Kd" [.1 .1 .8]
TransformBegin
Translate 0 .5 0
Material "matte" "color Kd" [.8 .8 .1]
Shape "sphere" "float radius" .8 "color Kd" [.1 .8 .1]
TransformEnd
Shape "disk" "float radius" 3
)",
       sky4 + R"(AttributeBegin
Translate 0 .5 0
Material "diffuse" "rgb reflectance" [.1 .8 .1]
Shape "sphere" "float radius" .8
AttributeEnd
Material "diffuse" "rgb reflectance" [.8 .8 .1]
Shape "disk" "float radius" 3
)"},
      {"uber with opacity", "", "",
       sky3 + room + R"(Material "uber" "rgb Kd" [.6 .3 .3] "rgb Ks" [0 0 0] "rgb opacity" [.4 .4 .4]
)" + ball,
       sky4 + room +
           R"(Material "diffuse" "rgb reflectance" [.6 .3 .3]
Translate 0 .5 0
Shape "sphere" "float radius" .8 "float alpha" .4
)"},
      {"shutter and meshes", R"(Camera "perspective" "float halffov" 20 "float shutterclose" .5
)",
       R"(Camera "perspective" "float fov" 40 "float shutterclose" .5
)",
       sky3 + R"(Shape "heightfield" "integer nu" 2 "integer nv" 2 "float Pz" [0 .5 .5 1]
Shape "trianglemesh" "point P" [-1 0 0 1 0 0 0 1 0] "integer indices" [0 1 2] "float st" [0 0 1 0 0 1]
)",
       sky4 + R"(Shape "trianglemesh" "point3 P" [0 0 0 1 0 .5 0 1 .5 1 1 1] "point2 uv" [0 0 1 0 0 1 1 1]
 "integer indices" [0 1 3 0 3 2]
Shape "trianglemesh" "point3 P" [-1 0 0 1 0 0 0 1 0] "integer indices" [0 1 2] "point2 uv" [0 0 1 0 0 1]
)",
       R"("float iso" 200)"},
      {"mix and translucent", "", "",
       sky3 +
           R"(MakeNamedMaterial "a" "string type" "matte" "rgb Kd" [.9 0 0]
MakeNamedMaterial "b" "string type" "translucent" "rgb Kd" [.4 .4 .8] "rgb Ks" [0 0 0] "rgb reflect" [.25 .5 .75]
Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "rgb amount" [.25 .25 .25]
)" + ball,
       sky4 +
           R"(MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [.9 0 0]
MakeNamedMaterial "b" "string type" "diffusetransmission" "rgb reflectance" [.1 .2 .6] "rgb transmittance" [.2 .2 .4]
Material "mix" "string materials" ["b" "a"] "float amount" .25
)" + ball},
  };
}

class UpgradedPictures : public testing::TestWithParam<Pair> {};

Image picture(const std::string& text, const std::filesystem::path& folder = ".") {
  const Scene scene = test::scene_from_text(text, folder);
  RenderOptions options = test::options_for("path", 8);
  options.color = ColorMode::rgb;
  return *select_layer(test::render_image(scene, options), "color");
}

// The same random numbers make the same paths, so that pictures only differ by rounding.
TEST_P(UpgradedPictures, AreThoseOfTheSameSceneInTheNewForm) {
  const Image found = picture(v3_text(GetParam())), expected = picture(v4_text(GetParam()));
  ASSERT_GT(test::mean_of(expected), 0.001);
  double difference = 0;
  for (std::size_t i = 0; i < found.pixels.size(); ++i)
    difference += std::abs(static_cast<double>(found.pixels[i]) - static_cast<double>(expected.pixels[i]));
  EXPECT_LT(difference / static_cast<double>(found.pixels.size()), 2e-4 * test::mean_of(expected));
}

INSTANTIATE_TEST_SUITE_P(V3, UpgradedPictures, testing::ValuesIn(pairs()),
                         [](const auto& instance) { return test::identifier(instance.param.name); });

// Under a uniform sky of radiance 1, the radiance of a flat body as wide as the picture is its material's albedo: at
// normal incidence; or for a sphere, the mean over all directions, weighted by their cosine.
double mean_albedo(const std::string& material) {
  const Scene scene = test::scene_from_text(
      R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-1 1 -1 1]
)" + v3_head +
      R"(WorldBegin
LightSource "infinite"
Material )" +
      material + R"(
Shape "sphere"
)");
  const Scene black = test::scene_from_text(
      R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-1 1 -1 1]
)" + v3_head +
      R"(WorldBegin
LightSource "infinite"
Material "matte" "color Kd" [0 0 0]
Shape "sphere"
)");
  const auto mean = [](const Scene& s) {
    RenderOptions options = test::options_for("path", 256);
    options.color = ColorMode::rgb;
    return test::mean_of(*select_layer(test::render_image(s, options), "color"));
  };
  const double around = mean(black);
  return (mean(scene) - around) / (1 - around);
}

struct Sum {
  std::string name, material;
  double albedo;  ///< the sum of pbrt-v3's lobes
};

// The mean Fresnel reflectance at index 1.5 is 0.0918 for a smooth surface. For GGX with shadowing it is 0.054 at an
// alpha of 0.3, and 0.040 at 0.49 (by separate Monte Carlo integration). Coats of that alpha are fits.
std::vector<Sum> sums() {
  const std::string smooth = R"( "float roughness" .001 "bool remaproughness" "false")";
  return {{"plastic", R"("plastic" "rgb Kd" [.5 .5 .5] "rgb Ks" [.4 .4 .4])" + smooth, .5 + .4 * .0918},
          {"bright plastic", R"("plastic" "rgb Kd" [.8 .8 .8] "rgb Ks" [1 1 1])" + smooth, .8 + .0918},
          {"uber with a mirror", R"("uber" "rgb Kd" [.4 .4 .4] "rgb Ks" [.2 .2 .2] "rgb Kr" [.5 .5 .5])" + smooth,
           .4 + .7 * .0918},
          {"translucent", R"("translucent" "rgb Kd" [.3 .3 .3] "rgb Ks" [0 0 0] "rgb transmit" [0 0 0])", .15},
          {"substrate",
           R"("substrate" "rgb Kd" [.5 .5 .5] "rgb Ks" [.04 .04 .04] "float uroughness" 0 "float vroughness" 0 )"
           R"("bool remaproughness" "false")",
           .8214 * .5 * .96 + .0918},
          {"substrate that mirrors",
           R"("substrate" "rgb Kd" [.8 .8 .8] "rgb Ks" [.5 .5 .5] "float uroughness" 0 "float vroughness" 0 )"
           R"("bool remaproughness" "false")",
           .8214 * .8 * .5 + .5 + .5 / 21},
          {"anisotropic substrate that mirrors",
           R"("substrate" "rgb Kd" [.8 .8 .8] "rgb Ks" [.5 .5 .5] "float uroughness" .05 "float vroughness" .2 )"
           R"("bool remaproughness" "false")",
           .8214 * .8 * .5 + .5 + .5 / 21},
          {"disney", R"("disney" "rgb color" [.6 .6 .6] "float roughness" .05)", .6 + .0918},
          {"rough substrate",
           R"("substrate" "rgb Kd" [.6 .6 .6] "rgb Ks" [.04 .04 .04] "float uroughness" .3 "float vroughness" .3 )"
           R"("bool remaproughness" "false")",
           .8214 * .6 * .96 + .054},
          {"bright rough disney", R"("disney" "rgb color" [.9 .9 .9] "float roughness" .7)", .9 + .04}};
}

class UpgradedAlbedos : public testing::TestWithParam<Sum> {};

TEST_P(UpgradedAlbedos, AreSumsOfLobes) { EXPECT_NEAR(mean_albedo(GetParam().material), GetParam().albedo, 0.015); }

INSTANTIATE_TEST_SUITE_P(V3, UpgradedAlbedos, testing::ValuesIn(sums()),
                         [](const auto& instance) { return test::identifier(instance.param.name); });

TEST(Upgrade, TheFirstSignTellsTheVersion) {
  const auto first_warning = [](const std::string& text) { return warnings_of(text).front(); };
  const std::string message = " belongs to pbrt-v3: the file is translated to pbrt-v4";
  EXPECT_EQ(first_warning(v3_head + "WorldBegin"), R"(1 Film "image")" + message);
  EXPECT_EQ(first_warning(R"(WorldBegin
Material "matte")"),
            R"(2 Material "matte")" + message);
  EXPECT_EQ(first_warning(R"(WorldBegin
MakeNamedMaterial "m" "string type" ["glass"])"),
            R"(2 Material "glass")" + message);
  EXPECT_EQ(first_warning(R"(PixelFilter "box" "float xwidth" 1
WorldBegin)"),
            R"(1 "float xwidth")" + message);
  EXPECT_EQ(first_warning(R"(WorldBegin
Texture "t" "color" "constant")"),
            R"(2 Texture "color")" + message);
  EXPECT_EQ(first_warning(R"(WorldBegin
Shape "sphere"
WorldEnd)"),
            "3 WorldEnd" + message);
  EXPECT_EQ(warnings_of(R"(WorldBegin
Texture "matte" "float" "constant"
Material "" # "color")")
                .size(),
            0u);
  EXPECT_EQ(first_warning(R"(Film "rgb"
WorldBegin
WorldEnd)"),
            "3 WorldEnd has no meaning in pbrt-v4: ignored");
}

TEST(Upgrade, IncludedFilesTellTheVersion) {
  const test::TemporaryDir dir;
  dir.write("film.pbrt", v3_head);
  const SceneDescription scene = read_pbrt_string(R"(Include "film.pbrt"
WorldBegin
Material "matte")",
                                                  dir.path(), "t.pbrt");
  EXPECT_EQ(scene.view.film.width, 24);
}

TEST(Upgrade, MixturesAreErrors) {
  EXPECT_EQ(error_of(v3_head + R"(WorldBegin
Material "diffuse")"),
            R"(t.pbrt:3:1: unknown material "diffuse"; it is of pbrt-v4, but Film "image" in line 1 is of pbrt-v3)");
  EXPECT_EQ(error_of(R"(Film "rgb"
WorldBegin
Material "matte")"),
            R"(t.pbrt:3:1: unknown material "matte"; it is of pbrt-v3, but Film "rgb" in line 1 is of pbrt-v4)");
  EXPECT_EQ(
      error_of(v3_head + R"(ColorSpace "rec2020")"),
      R"(t.pbrt:2:1: unknown directive "ColorSpace"; it is of pbrt-v4, but Film "image" in line 1 is of pbrt-v3)");
  EXPECT_EQ(error_of(v3_head + R"(WorldBegin
Material "mate")"),
            R"(t.pbrt:3:1: unknown material "mate")");
  EXPECT_EQ(error_of(R"(Film "rgb" "color x" [1 1 1])"), R"(t.pbrt:1:12: unknown parameter type "color")");
  EXPECT_EQ(
      error_of(R"(SurfaceIntegrator "photonmap")"),
      R"(t.pbrt:1:1: directive "SurfaceIntegrator" belongs to pbrt-v2: only pbrt-v3 and pbrt-v4 files are supported)");
}

TEST(Upgrade, ErrorsHavePlaces) {
  const std::string head = v3_head + "WorldBegin\n";
  EXPECT_EQ(error_of(head + "TransformBegin\nAttributeEnd"),
            "t.pbrt:4:1: AttributeEnd has no matching begin (the innermost open block begins at line 3)");
  EXPECT_EQ(error_of(head + "AttributeBegin\nTransformEnd"),
            "t.pbrt:4:1: TransformEnd has no matching begin (the innermost open block begins at line 3)");
  EXPECT_EQ(error_of(head + "TransformBegin"), "t.pbrt:3:1: the block that begins here has no end");
  EXPECT_EQ(error_of(head + R"(Material "mix" "string namedmaterial1" "a")"),
            R"(t.pbrt:3:1: Material "mix" needs "namedmaterial1" and "namedmaterial2")");
  EXPECT_EQ(error_of(head + R"(Material "matte" "float sigma" [1 2])"),
            R"(t.pbrt:3:18: parameter "sigma" of Material "matte" must be one value of type float)");
  EXPECT_EQ(error_of(head + R"(LightSource "point" "blackbody I" [0 1])"),
            R"(t.pbrt:3:21: blackbody "I" needs a temperature above 0 kelvin and a factor)");
  EXPECT_EQ(error_of(head + R"(Shape "heightfield" "integer nu" 2 "integer nv" 2 "float Pz" [1 2 3])"),
            R"(t.pbrt:3:1: Shape "heightfield" needs "nu" and "nv" from 2 to 32768 and nu * nv numbers "Pz")");
}

// Each approximation is reported once, with its first place and the number of places.
TEST(Upgrade, NotesAreCounted) {
  const std::vector<std::string> warnings = warnings_of(v3_head +
                                                        R"(Integrator "whitted"
WorldBegin
Shape "cone"
Shape "cone"
Shape "nurbs"
Material "matte" "float sigma" 20
Material "glass" "rgb Kt" [1 0 0]
Material "fourier"
Texture "t" "float" "constant" Shape "sphere" "texture shadowalpha" "t"
NamedMaterial "m"
Material "matte" "texture Kd" "u"
)");
  const std::vector<std::string> expected = {
      R"(1 Film "image" belongs to pbrt-v3: the file is translated to pbrt-v4)",
      R"(2 the integrator "whitted" is replaced by "path", which also includes all other light paths)",
      R"(4 shapes of kind "cone", which pbrt-v4 does not have, are converted to triangles (2 times))",
      R"(6 shapes of kind "nurbs", which pbrt-v4 does not have, are left out)",
      R"(7 the roughness "sigma" of the material "matte" is left out)",
      R"(8 "Kt" of Material "glass" is left out: the material is clear)",
      R"(9 the data of materials "fourier" cannot be read: they are replaced by "diffuse")",
      R"(10 "shadowalpha", a transparency for shadows only, is ignored)",
      R"(11 material "m" is not defined before it is used: the current material does not change, as in pbrt-v3)",
      R"(12 texture "u" is not defined before it is used: "Kd" keeps its default, as in pbrt-v3)"};
  EXPECT_EQ(warnings, expected);
}

const auto& material_of(const SceneDescription& scene, std::size_t shape) {
  return scene.materials[scene.shapes[shape].material];
}

TEST(Upgrade, EitherEndEndsAnAttributeOrAnObject) {
  const SceneDescription scene = read(v3_head +
                                      R"(WorldBegin
AttributeBegin
ObjectBegin "o"
Translate 1 0 0
Shape "sphere"
AttributeEnd
ObjectEnd
ObjectInstance "o"
)");
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].shapes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].location.line, 9);
}

TEST(Upgrade, NamesEndWithTheirBlocks) {
  const SceneDescription scene = read(v3_head +
                                      R"(WorldBegin
MakeNamedMaterial "m" "string type" "matte" "color Kd" [.1 .1 .1]
AttributeBegin
MakeNamedMaterial "m" "string type" "mirror"
NamedMaterial "m"
Shape "sphere"
AttributeEnd
NamedMaterial "m"
Shape "sphere"
ObjectBegin "o"
Shape "sphere"
ObjectEnd
ObjectInstance "o"
ObjectBegin "o"
Shape "sphere"
Shape "sphere"
ObjectEnd
ObjectInstance "o"
)");
  EXPECT_TRUE(std::holds_alternative<description::ConductorMaterial>(material_of(scene, 0).node));
  EXPECT_TRUE(std::holds_alternative<description::DiffuseMaterial>(material_of(scene, 1).node));
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.objects[scene.instances[0].object].shapes.size(), 1u);
  EXPECT_EQ(scene.objects[scene.instances[1].object].shapes.size(), 2u);
}

// In pbrt-v4 they would be dark.
TEST(Upgrade, LampsWithoutAMaterialEmit) {
  const SceneDescription scene = read(v3_head +
                                      R"(WorldBegin
Material "none"
AttributeBegin
AreaLightSource "diffuse"
Shape "sphere"
AttributeEnd
Shape "sphere"
)");
  EXPECT_TRUE(scene.shapes[0].area_light);
  EXPECT_TRUE(std::holds_alternative<description::DiffuseMaterial>(material_of(scene, 0).node));
  EXPECT_TRUE(std::holds_alternative<description::InterfaceMaterial>(material_of(scene, 1).node));
}

// Colour textures get a float twin where numbers are needed.
TEST(Upgrade, TexturesAsAmounts) {
  const SceneDescription scene = read(v3_head +
                                      R"(WorldBegin
Texture "t" "color" "checkerboard" "color tex1" [.2 .4 .6] "color tex2" [1 1 1]
MakeNamedMaterial "a" "string type" "matte"
MakeNamedMaterial "b" "string type" "mirror"
Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "texture amount" "t"
Shape "sphere"
Material "uber" "texture opacity" "t"
Shape "sphere"
)");
  const auto& mix = std::get<description::MixMaterial>(material_of(scene, 0).node);
  ASSERT_TRUE(mix.amount.texture);
  const auto& twin =
      std::get<description::Checkerboard<description::FloatParameter>>(scene.float_textures[*mix.amount.texture].node);
  EXPECT_NEAR(twin.tex1.value, 0.4f, 1e-6f);
  EXPECT_EQ(scene.shapes[1].alpha.texture, mix.amount.texture);
}

std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The text describes the same scene, and files are found from its folder.
TEST(Upgrade, WritesTheTranslation) {
  const test::TemporaryDir dir;
  std::filesystem::create_directories(dir.path() / "new");
  dir.write("old/light.spd", "400 1\n700 2\n");
  dir.write("old/parts/one.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  dir.write("old/parts/mesh.pbrt", R"(Shape "plymesh" "string filename" "parts/one.ply"
)");
  dir.write("old/scene.pbrt", camera + v3_head +
                                  R"(WorldBegin # a comment
LightSource "point" "spectrum I" "light.spd"
Transform [1 0 0 0 0 1 0 0 0 0 1 0 .1 .2 .3 1]
Material "plastic" "color Kd" [.3 .2 .1]
Include "parts/mesh.pbrt"
)");
  const UpgradedScene upgraded = upgrade_pbrt(dir.path() / "old/scene.pbrt", dir.path() / "new");
  dir.write("new/scene.pbrt", upgraded.text);
  EXPECT_EQ(upgraded.files.size(), 2u);
  const SceneDescription before = read_scene(dir.path() / "old/scene.pbrt");
  const SceneDescription after = read_scene(dir.path() / "new/scene.pbrt");
  EXPECT_EQ(after.warnings.size(), 0u) << after.warnings.front().message;
  EXPECT_EQ(picture(file_text(dir.path() / "new/scene.pbrt"), dir.path() / "new").pixels,
            picture(file_text(dir.path() / "old/scene.pbrt"), dir.path() / "old").pixels);
  EXPECT_EQ(before.materials.size(), after.materials.size());
  EXPECT_EQ(after.files.count("../old/parts/one.ply"), 1u);
  EXPECT_EQ(test::error_text([&] { upgrade_pbrt(dir.path() / "new/scene.pbrt", dir.path()); }),
            (dir.path() / "new/scene.pbrt").string() +
                R"(: Film "rgb" in line 4 belongs to pbrt-v4: there is nothing to convert)");
}

// Features of pbrt-v2 only are translated, or skipped with a warning; the rest is as in pbrt-v3.
TEST(Upgrade, FilesOfPbrtV2AreRead) {
  const std::string world =
      R"(WorldBegin
AttributeBegin
AreaLightSource "area" "color L" [3 2 1] "integer nsamples" 4
Shape "disk"
AttributeEnd
Material "measured" "string filename" "no.brdf"
Shape "sphere"
)";
  const std::string head = R"(SurfaceIntegrator "path" "integer maxdepth" 7
VolumeIntegrator "single"
)" + v3_head + R"(Renderer "metropolis" "integer samplesperpixel" 128
)" + world;
  const std::string text = head + R"(Volume "homogeneous" "color sigma_s" [1 1 1]
WorldEnd
)";
  const SceneDescription scene = read(text);
  EXPECT_EQ(scene.hints.integrator, "path");
  EXPECT_EQ(scene.hints.max_depth, 7);
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_TRUE(scene.shapes[0].area_light);
  EXPECT_TRUE(std::holds_alternative<description::DiffuseMaterial>(scene.materials.at(scene.shapes[1].material).node));
  const std::vector<std::string> said = warnings_of(text);
  for (const char* name : {"Renderer", "Volume", "VolumeIntegrator"})
    EXPECT_TRUE(std::any_of(said.begin(), said.end(), [&](const std::string& warning) {
      return warning.ends_with("directive \"" + std::string(name) + "\" belongs to pbrt-v2: ignored");
    })) << name;
  const auto milk = [](const std::string& name) {
    return read(v3_head + R"(WorldBegin
Material "subsurface" "color sigma_a" [1 2 3] "color )" +
                name +
                R"(" [4 5 6]
Shape "sphere")");
  };
  EXPECT_EQ(milk("sigma_prime_s").media.size(), 1u);
  EXPECT_EQ(warnings_of(v3_head + R"(WorldBegin
Material "subsurface" "color sigma_prime_s" [4 5 6])")
                .size(),
            1u);
}

// A name from pbrt-v2, with its parameters there.
TEST(Upgrade, PhotonMapsAreOurs) {
  const std::string head = v3_head +
                           R"(Integrator "photonmap" "integer causticphotons" 5000 "integer indirectphotons" )"
                           R"(7000 "integer nused" 1000 "float maxdist" .25 "integer maxphotondepth" 7 )"
                           R"("integer finalgathersamples" 9 "float gatherangle" 10 )";
  const auto hints = read(head + "WorldBegin WorldEnd").hints;
  EXPECT_EQ(hints.integrator, "photonmap");
  EXPECT_EQ(hints.parameters,
            (std::map<std::string, std::string>{
                {"caustic-photons", "5000"}, {"gather", "9"}, {"max-radius", "0.25"}, {"nearest", "256"}}));
  EXPECT_EQ(hints.photons_per_iteration, 7000);
  EXPECT_EQ(hints.max_depth, 12);
  const auto said = [&](const std::string& more) {
    const std::vector<std::string> all = warnings_of(head + more + "WorldBegin WorldEnd");
    return all.empty() ? std::string() : all.back();
  };
  const std::string replaced = R"(2 the integrator "photonmap" is of pbrt-v2: Lanthorn's photonmap replaces it)";
  EXPECT_EQ(said(""), replaced);
  EXPECT_EQ(said(R"("bool finalgather" false )"),
            replaced + R"(, which uses final gathering although "finalgather" is false)");
}

// Quadrics that pbrt-v4 lacks: their points and normals, against the surfaces' equation f(p) = 0 and grad f.
TEST(Upgrade, QuadricsAreMeshes) {
  struct Quadric {
    std::string text;
    float (*f)(const Point&);
    Vec3 (*gradient)(const Point&);
    Bounds bounds;
  };
  const std::vector<Quadric> quadrics = {
      {R"("cone" "float radius" 2 "float height" 3)",
       [](const Point& p) { return std::hypot(p.x, p.y) - 2 * (1 - p.z / 3); },
       [](const Point& p) { return Vec3(Vec3(p.x, p.y, 0) / std::hypot(p.x, p.y) + Vec3(0, 0, 2.0f / 3)); },
       {{-2, -2, 0}, {2, 2, 3}}},
      {R"("paraboloid" "float radius" 2 "float zmin" 1 "float zmax" 4)",
       [](const Point& p) { return p.x * p.x + p.y * p.y - p.z; },
       [](const Point& p) { return Vec3(2 * p.x, 2 * p.y, -1); },
       {{-2, -2, 1}, {2, 2, 4}}},
      {R"("hyperboloid" "point p1" [1 1 -1] "point p2" [1 -1 1])",
       [](const Point& p) { return p.x * p.x + p.y * p.y - p.z * p.z - 1; },
       [](const Point& p) { return Vec3(2 * p.x, 2 * p.y, -2 * p.z); },
       {{-std::sqrt(2.0f), -std::sqrt(2.0f), -1}, {std::sqrt(2.0f), std::sqrt(2.0f), 1}}}};
  for (const Quadric& q : quadrics) {
    const SceneDescription scene = read(v3_head + "WorldBegin Shape " + q.text + "\nWorldEnd");
    const auto& mesh = std::get<description::TriangleMesh>(scene.shapes.at(0).geometry);
    Bounds bounds;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const Point& p = mesh.positions[i];
      bounds.extend(p);
      EXPECT_NEAR(q.f(p), 0, 1e-5f) << q.text;
      if (std::hypot(p.x, p.y) < 1e-3f) continue;
      const float cosine = dot(normalize(mesh.normals[i]), normalize(q.gradient(p)));
      EXPECT_NEAR(std::fabs(cosine), 1, 1e-4f) << q.text << ' ' << p.z;
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(bounds.min[k], q.bounds.min[k], 1e-3f) << q.text;
      EXPECT_NEAR(bounds.max[k], q.bounds.max[k], 1e-3f) << q.text;
    }
  }
  EXPECT_EQ(error_of(v3_head + R"(WorldBegin Shape "paraboloid" "float zmax" 0
WorldEnd)"),
            R"(t.pbrt:2:12: Shape "paraboloid" needs 0 <= zmin < zmax)");
}

// The texture "uv" returns fractional parts: (-1) u + 0 becomes 1 - u, 0.5 u + 2.25 becomes 0.25 + 0.5 u.
TEST(Upgrade, CoordinatesAsColoursStayBetween0And1) {
  const SceneDescription scene =
      read(v3_head +
           R"(WorldBegin Texture "t" "color" "uv" "float uscale" -1 "float vscale" .5 "float vdelta" 2.25
Material "matte" "texture Kd" "t" Shape "sphere"
WorldEnd)");
  const auto& bilerp =
      std::get<description::BilerpTexture<description::SpectrumParameter>>(scene.spectrum_textures.at(0).node);
  const auto& mapping = std::get<description::UvMapping>(bilerp.mapping);
  EXPECT_EQ(mapping.linear * Vec2(0.25f, 1) + mapping.offset, Vec2(0.75f, 0.75f));
  EXPECT_EQ(warnings_of(v3_head + R"(WorldBegin Texture "t" "color" "uv" "float uscale" 3 WorldEnd)").back(),
            R"(2 textures "uv" do not repeat)");
}

}  // namespace
}  // namespace lanthorn::upgrade_test
