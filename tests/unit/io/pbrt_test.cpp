// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The grammar of pbrt-v4 files: tokens, directives, state, included files, locations of errors.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/pbrt/assembler.h"
#include "io/pbrt/parser.h"
#include "io/pbrt/reader.h"
#include "io/pbrt/tokenizer.h"
#include "lanthorn/scene.h"
#include "render/method_of_file.h"
#include "support/error_text.h"
#include "support/gzip.h"
#include "support/shared_dir.h"
#include "support/temporary_dir.h"

namespace lanthorn::pbrt_test {
namespace {

SceneDescription read(const std::string& text) { return read_pbrt_string(text, ".", "t.pbrt"); }

std::string error_of(const std::string& text) {
  return test::error_text([&] { read(text); });
}

Point image_of(const AnimatedTransform& t, const Point& p) { return t.start.point(p); }

void expect_near(const Point& a, const Point& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-5f) << i;
}

TEST(PbrtTokenizer, CutsTokensAndCountsPlaces) {
  const std::string file = "f";
  pbrt::Tokenizer tokens("\xEF\xBB\xBFWord[1 -0.5]# comment \"[\n\t\"a b\"\"\\\"\\n\"x#\r\n  y", &file);
  struct Expected {
    pbrt::TokenKind kind;
    std::string text;
    int line, column;
  };
  using enum pbrt::TokenKind;
  const std::vector<Expected> expected = {{word, "Word", 1, 1},      {open, "[", 1, 5},   {word, "1", 1, 6},
                                          {word, "-0.5", 1, 8},      {close, "]", 1, 12}, {string, "a b", 2, 2},
                                          {string, "\\\"\\n", 2, 7}, {word, "x", 2, 13},  {word, "y", 3, 3},
                                          {end, "", 3, 4},           {end, "", 3, 4}};
  for (const Expected& e : expected) {
    const pbrt::Token token = tokens.next();
    EXPECT_EQ(token.kind, e.kind) << e.text;
    EXPECT_EQ(token.text, e.text);
    EXPECT_EQ(token.place.line, e.line) << e.text;
    EXPECT_EQ(token.place.column, e.column) << e.text;
    if (token.has_escapes) {
      EXPECT_EQ(pbrt::string_value(token), "\"\n");
    }
  }
}

TEST(PbrtTokenizer, ReadsNumbers) {
  const auto number = [](std::string_view text) { return pbrt::float_value({pbrt::TokenKind::word, text, {}}); };
  EXPECT_EQ(number("1"), 1);
  EXPECT_EQ(number("-0"), 0);
  EXPECT_TRUE(std::signbit(number("-0")));
  EXPECT_EQ(number("+.5"), 0.5f);
  EXPECT_EQ(number("5."), 5);
  EXPECT_EQ(number("1e5"), 1e5f);
  EXPECT_EQ(number("-1.5E-2"), -1.5e-2f);
  EXPECT_EQ(number("1.5,"), 1.5f);  // pbrt ignores commas
  EXPECT_EQ(number("1e-60"), 0);
  EXPECT_EQ(number("1e-600"), 0);
  EXPECT_EQ(number("0." + std::string(400, '0') + "1"), 0);
  for (const std::string text :
       {"", "-", "+-1", "1x", "x1", "inf", "nan", "-inf", "0x10", "1e39", "1e400", "1,5", "1,,", ",", "."})
    EXPECT_THROW(number(text), Error) << text;
  const auto integer = [](std::string_view text) { return pbrt::integer_value({pbrt::TokenKind::word, text, {}}); };
  EXPECT_EQ(integer("-2147483648"), -2147483648LL);
  EXPECT_EQ(integer("+7"), 7);
  EXPECT_EQ(integer("7,"), 7);
  for (const std::string text : {"2147483648", "1.0", "1e3", "", "a"}) EXPECT_THROW(integer(text), Error) << text;
}

// Every error has an exact location and states the problem.
TEST(Pbrt, ErrorsHavePlaces) {
  struct Bad {
    std::string text, message;
  };
  const std::string square = R"("point3 P" [0 0 0 1 0 0 1 1 0 0 1 0])";
  const std::vector<Bad> bad = {
      {"", "t.pbrt:1:1: the scene has no WorldBegin"},
      {"WorldBegin\n  Frobnicate 1", R"(t.pbrt:2:3: unknown directive "Frobnicate")"},
      {"WorldBegin [", R"(t.pbrt:1:12: expected a directive, found "[")"},
      {"WorldBegin\n\"open", "t.pbrt:2:1: the string that starts here has no closing quote on its line"},
      {R"(WorldBegin
Texture "a
b")",
       "t.pbrt:2:9: the string that starts here has no closing quote on its line"},
      {R"(Film "r\qb")", R"(t.pbrt:1:8: unknown escape "\\q" in a string)"},
      {"Translate 1 2", "t.pbrt:1:14: expected a number, found the end of the file"},
      {"Translate 1 2\nz", R"(t.pbrt:2:1: expected a number, found "z")"},
      {"Translate 1 2 1e99", R"(t.pbrt:1:15: the number "1e99" is too large)"},
      {"Transform 1 0", R"(t.pbrt:1:11: expected "[" and 16 numbers, found "1")"},
      {"Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 5]", R"(t.pbrt:1:44: expected "]" after 16 numbers, found "5")"},
      {R"(WorldBegin Transform [1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1]
LightSource "point")",
       "t.pbrt:2:1: the transform of a light must have an inverse"},
      {R"(WorldBegin Scale 1 0 1
Texture "t" "float" "fbm")",
       "t.pbrt:2:1: the transform of a texture must have an inverse"},
      {"Rotate 3 0 0 0", "t.pbrt:1:1: Rotate needs an axis that is not zero"},
      {"LookAt 0 0 0 0 0 0 0 1 0",
       "t.pbrt:1:1: LookAt needs a target apart from the eye, and an up vector not along the view"},
      {"ActiveTransform Middle", R"(t.pbrt:1:17: expected All, StartTime or EndTime, found "Middle")"},
      {"TransformTimes 1 1", "t.pbrt:1:1: TransformTimes needs an end time after the start time"},
      {"Camera perspective", R"(t.pbrt:1:8: expected a kind or name in quotes, found "perspective")"},
      {R"(Camera "pinhole")", R"(t.pbrt:1:1: unknown camera "pinhole")"},
      {R"(Film "rgb" "xresolution" 5)", R"(t.pbrt:1:12: expected a parameter "type name", found "xresolution")"},
      {R"(Film "rgb" "double x" 5)", R"(t.pbrt:1:12: unknown parameter type "double")"},
      {R"(Film "rgb" "integer xresolution" 5.5)", R"(t.pbrt:1:34: expected an integer, found "5.5")"},
      {R"(Film "rgb" "integer xresolution" [5)", R"(t.pbrt:1:36: expected a value or "]", found the end of the file)"},
      {R"(Film "rgb" "integer xresolution" [5 [)", R"(t.pbrt:1:37: expected an integer, found "[")"},
      {R"(Film "rgb"
 "float xresolution" [5]
WorldBegin)",
       R"(t.pbrt:2:2: parameter "xresolution" of Film "rgb" must be of type integer, not float)"},
      {R"(Film "rgb"
 "integer xresolution" [5 6]
WorldBegin)",
       R"(t.pbrt:2:2: parameter "xresolution" of Film "rgb" needs one value, has 2)"},
      {R"(Film "rgb" "string filename" [name])", R"(t.pbrt:1:31: expected a string in quotes, found "name")"},
      {R"(Integrator "path" "bool regularize" yes)", R"(t.pbrt:1:37: expected true or false, found "yes")"},
      {"WorldBegin WorldBegin", "t.pbrt:1:12: this is the second WorldBegin"},
      {R"(WorldBegin Camera "perspective")", "t.pbrt:1:12: Camera must come before WorldBegin"},
      {R"(Shape "sphere")", "t.pbrt:1:1: Shape must come after WorldBegin"},
      {"WorldBegin AttributeEnd", "t.pbrt:1:12: AttributeEnd has no matching begin"},
      {R"(WorldBegin
AttributeBegin ObjectBegin "o"
AttributeEnd)",
       "t.pbrt:3:1: AttributeEnd has no matching begin (the innermost open block begins at line 2)"},
      {"WorldBegin\n AttributeBegin\n", "t.pbrt:2:2: the block that begins here has no end"},
      {R"(WorldBegin ObjectBegin "o" ObjectBegin "p")", "t.pbrt:1:28: ObjectBegin inside an object"},
      {R"(WorldBegin ObjectBegin "o" ObjectEnd ObjectBegin "o")", R"(t.pbrt:1:38: object "o" is defined twice)"},
      {R"(WorldBegin ObjectBegin "o" ObjectInstance "o")", "t.pbrt:1:28: ObjectInstance inside an object"},
      {R"(WorldBegin
ObjectInstance "o")",
       R"(t.pbrt:2:1: object "o" is not defined)"},
      {R"(WorldBegin
NamedMaterial "m")",
       R"(t.pbrt:2:1: material "m" is not defined)"},
      {R"(WorldBegin MakeNamedMaterial "m")", R"(t.pbrt:1:12: parameter "type" of MakeNamedMaterial "m" is missing)"},
      {R"(WorldBegin MakeNamedMaterial "m" "string type" "diffuse"
MakeNamedMaterial "m")",
       R"(t.pbrt:2:1: material "m" is defined twice)"},
      {R"(WorldBegin Material "gold")", R"(t.pbrt:1:12: unknown material "gold")"},
      {R"(WorldBegin Material "diffuse" "texture reflectance" "t")",
       R"(t.pbrt:1:31: parameter "reflectance" of Material "diffuse" names the spectrum texture "t", which is not )"
       "defined"},
      {R"(WorldBegin Material "diffuse" "rgb reflectance" [1 1])",
       R"(t.pbrt:1:31: parameter "reflectance" of Material "diffuse" needs three values, has 2)"},
      {R"(WorldBegin Material "diffuse" "rgb reflectance" [0 -1 0])",
       R"(t.pbrt:1:31: parameter "reflectance" of Material "diffuse" must not be negative)"},
      {R"(WorldBegin Material "diffuse" "spectrum reflectance" [400 1 300 1])",
       R"(t.pbrt:1:31: parameter "reflectance" of Material "diffuse" needs wavelengths in increasing order)"},
      {R"(WorldBegin Material "mix" "string materials" ["a" "b"])",
       R"(t.pbrt:1:27: parameter "materials" of Material "mix" names "a", which is not defined before it)"},
      {R"(WorldBegin Material "conductor" "rgb reflectance" [1 1 1]
 "rgb k" [1 1 1])",
       R"(t.pbrt:1:33: parameter "reflectance" of Material "conductor" cannot be given together with "eta" or )"
       R"("k")"},
      {R"(WorldBegin Texture "t" "colour" "constant")",
       R"(t.pbrt:1:12: a texture's type must be float or spectrum, not "colour")"},
      {R"(WorldBegin Texture "t" "float" "noise")", R"(t.pbrt:1:12: unknown texture "noise")"},
      {R"(WorldBegin Texture "t" "float" "imagemap")",
       R"(t.pbrt:1:12: parameter "filename" of Texture "imagemap" is missing)"},
      {R"(WorldBegin Texture "t" "float" "constant"
Texture "t" "float" "constant")",
       R"(t.pbrt:2:1: texture "t" is defined twice)"},
      {R"(WorldBegin LightSource "sun")", R"(t.pbrt:1:12: unknown light "sun")"},
      {R"(WorldBegin LightSource "point" "float I" 1)",
       R"(t.pbrt:1:32: parameter "I" of LightSource "point" must be a spectrum (rgb, blackbody or spectrum), not )"
       "float"},
      {R"(WorldBegin AreaLightSource "sphere")", R"(t.pbrt:1:12: unknown area light "sphere")"},
      {R"(WorldBegin Shape "cube")", R"(t.pbrt:1:12: unknown shape "cube")"},
      {R"(WorldBegin Shape "trianglemesh")", R"(t.pbrt:1:12: parameter "P" of Shape "trianglemesh" is missing)"},
      {R"(WorldBegin Shape "trianglemesh" )" + square,
       R"(t.pbrt:1:12: parameter "indices" of Shape "trianglemesh" is missing)"},
      {R"(WorldBegin Shape "trianglemesh" )" + square + R"( "integer indices" [0 1])",
       R"(t.pbrt:1:70: parameter "indices" of Shape "trianglemesh" needs a multiple of 3 values, has 2)"},
      {R"(WorldBegin Shape "trianglemesh" )" + square + R"( "integer indices" [0 1 4])",
       R"(t.pbrt:1:70: parameter "indices" of Shape "trianglemesh" has the value 4, but there are 4 points)"},
      {R"(WorldBegin Shape "trianglemesh" )" + square + R"( "integer indices" [0 1 -1])",
       R"(t.pbrt:1:70: parameter "indices" of Shape "trianglemesh" has the value -1, but there are 4 points)"},
      {R"(WorldBegin Shape "trianglemesh" "point3 P" [0 0 0 1])",
       R"(t.pbrt:1:33: parameter "P" of Shape "trianglemesh" needs a multiple of 3 values, has 4)"},
      {R"(WorldBegin Shape "bilinearmesh" )" + square + R"( "point2 uv" [0 0])",
       R"(t.pbrt:1:70: parameter "uv" of Shape "bilinearmesh" has 1 entries, but there are 4 points)"},
      {R"(WorldBegin Shape "sphere" "texture alpha" "t")", R"(t.pbrt:1:12: float texture "t" is not defined)"},
      {R"(WorldBegin
Shape "plymesh" "string filename" "no.ply")",
       "t.pbrt:2:1: ./no.ply: no such file"},
      {R"(WorldBegin Attribute "camera")",
       R"(t.pbrt:1:12: unknown Attribute target "camera": it must be shape, light, material, medium or texture)"},
      {R"(ColorSpace "adobe")", R"(t.pbrt:1:1: unknown color space "adobe")"},
      {R"(Option "seed" x)", R"(t.pbrt:1:1: Option "seed" needs an integer, not "x")"},
      {R"(WorldBegin MediumInterface "fog")", R"(t.pbrt:1:12: medium "fog" is not defined)"},
      {R"(Include "no.pbrt")", "t.pbrt:1:1: no.pbrt: no such file"},
  };
  for (const Bad& b : bad) EXPECT_EQ(error_of(b.text), b.message) << b.text;
}

TEST(Pbrt, TransformsCompose) {
  const auto scene = read(
      R"(WorldBegin Translate 1 2 3 Rotate 90 0 0 1 Scale 2 1 1 Shape "sphere"
Identity Transform [2 0 0 0 0 1 0 0 0 0 1 0 5 0 0 1] Shape "sphere"
ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1] Shape "sphere"
CoordinateSystem "here" Identity Shape "sphere" CoordSysTransform "here" Shape "sphere"
CoordSysTransform "world" Shape "sphere")");
  ASSERT_EQ(scene.shapes.size(), 6u);
  const auto image = [&](std::size_t i) { return image_of(scene.shapes[i].object_to_world, {1, 0, 0}); };
  expect_near(image(0), {1, 4, 3});
  expect_near(image(1), {7, 0, 0});
  expect_near(image(2), {9, 0, 0});
  expect_near(image(3), {1, 0, 0});
  expect_near(image(4), {9, 0, 0});
  expect_near(image(5), {1, 0, 0});
}

TEST(Pbrt, CameraTransformIsTheInverse) {
  const auto scene = read(
      R"(LookAt 1 2 3  1 2 10  0 1 0 Camera "perspective" WorldBegin
CoordSysTransform "camera" Shape "sphere")");
  expect_near(image_of(scene.view.camera.camera_to_world, {0, 0, 1}), {1, 2, 4});
  expect_near(image_of(scene.view.camera.camera_to_world, {0, 1, 0}), {1, 3, 3});
  EXPECT_EQ(scene.shapes[0].object_to_world.start, scene.view.camera.camera_to_world.start);
  EXPECT_FALSE(scene.view.camera.camera_to_world.is_moving());
}

TEST(Pbrt, ActiveTransformMovesShapes) {
  const auto scene = read(
      R"(TransformTimes 2 4 WorldBegin ActiveTransform StartTime Translate 1 0 0
ActiveTransform EndTime Translate 0 1 0 ActiveTransform All Translate 0 0 1 Shape "sphere"
LightSource "point" Identity Shape "sphere")");
  const AnimatedTransform& moving = scene.shapes[0].object_to_world;
  EXPECT_EQ(moving.start_time, 2);
  EXPECT_EQ(moving.end_time, 4);
  expect_near(moving.start.point({0, 0, 0}), {1, 0, 1});
  expect_near(moving.end.point({0, 0, 0}), {0, 1, 1});
  EXPECT_FALSE(scene.shapes[1].object_to_world.is_moving());
  expect_near(scene.lights[0].light_to_world.point({0, 0, 0}), {1, 0, 1});
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0].message, "a light cannot move: it stays where it is at the start time");
}

TEST(Pbrt, AttributesAreRestored) {
  const auto scene = read(
      R"(WorldBegin MakeNamedMaterial "m" "string type" "interface"
AttributeBegin Translate 1 0 0 ReverseOrientation NamedMaterial "m" AreaLightSource "diffuse" ColorSpace "rec2020"
 AttributeBegin Material "diffuse" Shape "sphere" AttributeEnd
AttributeEnd Shape "sphere" LightSource "point" "rgb I" [1 1 1])");
  const auto& inner = scene.shapes[0];
  const auto& outer = scene.shapes[1];
  EXPECT_TRUE(inner.reverse_orientation);
  EXPECT_TRUE(inner.area_light.has_value());
  expect_near(image_of(inner.object_to_world, {0, 0, 0}), {1, 0, 0});
  EXPECT_FALSE(outer.reverse_orientation);
  EXPECT_FALSE(outer.area_light.has_value());
  EXPECT_EQ(outer.material, 0u);
  expect_near(image_of(outer.object_to_world, {0, 0, 0}), {0, 0, 0});
  const auto& light = std::get<description::PointLight>(scene.lights[0].node);
  EXPECT_EQ(std::get<description::RgbSpectrum>(light.intensity.spectrum).space, ColorSpace::srgb);
  const auto& emitter = std::get<description::RgbSpectrum>(scene.area_lights[0].radiance.value);
  EXPECT_EQ(emitter.space, ColorSpace::srgb) << "the light was given before the colour space";
}

TEST(Pbrt, AttributeGivesDefaults) {
  const auto scene = read(
      R"(ColorSpace "aces2065-1" WorldBegin Attribute "shape" "float radius" 3 "float unknown" 1
Attribute "light" "rgb L" [2 2 2] Attribute "material" "float roughness" 0.5
Attribute "texture" "float scale" 7
Shape "sphere" Shape "sphere" "float radius" 4 LightSource "infinite" Material "dielectric"
Texture "t" "float" "imagemap" "string filename" "a.png"
AttributeBegin Attribute "shape" "float radius" 5 Shape "sphere" AttributeEnd Shape "sphere")");
  std::vector<float> radii;
  for (const auto& shape : scene.shapes) radii.push_back(std::get<description::Sphere>(shape.geometry).radius);
  EXPECT_EQ(radii, (std::vector<float>{3, 4, 5, 3}));
  const auto& light = std::get<description::InfiniteLight>(scene.lights[0].node);
  EXPECT_EQ(std::get<description::RgbSpectrum>(light.radiance.spectrum).rgb, (Rgb{2, 2, 2}));
  EXPECT_EQ(std::get<description::RgbSpectrum>(light.radiance.spectrum).space, ColorSpace::aces2065_1);
  EXPECT_EQ(std::get<description::DielectricMaterial>(scene.materials[1].node).roughness.u.value, 0.5f);
  EXPECT_EQ(std::get<description::ImageTexture>(scene.float_textures[0].node).scale, 7);
  EXPECT_TRUE(scene.warnings.empty()) << "defaults need not suit every shape";
}

TEST(Pbrt, ObjectsAndInstances) {
  const auto scene = read(
      R"(WorldBegin ObjectInstance "later" Translate 1 0 0
ObjectBegin "o" Translate 0 1 0 Shape "sphere" AreaLightSource "diffuse" Shape "disk" ObjectEnd
Scale 2 2 2 ObjectInstance "o" Shape "cylinder"
ObjectBegin "later" ObjectEnd)");
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].name, "later");
  ASSERT_EQ(scene.objects[1].shapes.size(), 2u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[1].object, 1u);
  EXPECT_EQ(scene.shapes.size(), 1u);
  expect_near(image_of(scene.objects[1].shapes[0].object_to_world, {0, 0, 0}), {1, 1, 0});
  expect_near(image_of(scene.instances[1].object_to_world, {1, 1, 0}), {3, 2, 0});
  EXPECT_TRUE(scene.objects[1].shapes[1].area_light.has_value());
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Pbrt, NamedMaterialsMayBeDefinedLater) {
  const auto scene = read(
      R"(WorldBegin NamedMaterial "late" Shape "sphere" Material "mix" "string materials" ["late" "late"]
Shape "sphere" Material "diffuse" "texture reflectance" "t" Shape "sphere" "texture alpha" "f"
Texture "t" "spectrum" "constant" Texture "f" "float" "constant"
MakeNamedMaterial "late" "string type" "conductor")");
  const auto material = [&](std::size_t i) { return scene.materials[scene.shapes[i].material]; };
  EXPECT_EQ(material(0).name, "late");
  EXPECT_TRUE(std::holds_alternative<description::ConductorMaterial>(material(0).node));
  EXPECT_EQ(std::get<description::MixMaterial>(material(1).node).materials[1], scene.shapes[0].material);
  EXPECT_EQ(std::get<description::DiffuseMaterial>(material(2).node).reflectance.texture, 0u);
  EXPECT_EQ(scene.shapes[2].alpha.texture, 0u);
}

TEST(Pbrt, IncludesAndImports) {
  const test::TemporaryDir dir;
  dir.write("parts/a.pbrt", R"(Translate 1 0 0 Include "parts/b.pbrt")");
  dir.write("parts/b.pbrt", R"(Shape "sphere" AttributeEnd)");
  dir.write("parts/i.pbrt.gz",
            test::gzip(R"(Translate 5 0 0 MakeNamedMaterial "m" "string type" "diffuse" Shape "sphere")"));
  const auto scene = read_scene(dir.write("main.pbrt",
                                          R"(WorldBegin AttributeBegin Include "parts/a.pbrt"
Import "parts/i.pbrt.gz" NamedMaterial "m" Shape "sphere")"));
  ASSERT_EQ(scene.shapes.size(), 3u);
  expect_near(image_of(scene.shapes[0].object_to_world, {0, 0, 0}), {1, 0, 0});
  expect_near(image_of(scene.shapes[1].object_to_world, {0, 0, 0}), {5, 0, 0});
  expect_near(image_of(scene.shapes[2].object_to_world, {0, 0, 0}), {0, 0, 0});
  EXPECT_EQ(scene.shapes[0].location.file, (dir.path() / "parts/b.pbrt").string());
  EXPECT_EQ(scene.materials[scene.shapes[2].material].name, "m");
}

TEST(Pbrt, IncludeErrors) {
  const test::TemporaryDir dir;
  const std::string folder = dir.path().string() + "/";
  const auto error_in = [&](const std::string& text) {
    return test::error_text([&] { read_scene(dir.write("main.pbrt", text)); });
  };
  dir.write("self.pbrt", R"(
Include "./self.pbrt")");
  dir.write("back.pbrt", R"(Include "main.pbrt")");
  dir.write("bad.pbrt", "\n\n  Translate x");
  dir.write("open.pbrt", "AttributeBegin");
  dir.write("close.pbrt", "AttributeEnd");
  EXPECT_EQ(error_in(R"(Include "self.pbrt")"),
            folder + "self.pbrt:2:1: file \"" + folder + "self.pbrt\" includes itself");
  EXPECT_EQ(error_in(R"(Include "back.pbrt")"),
            folder + "back.pbrt:1:1: file \"" + folder + "main.pbrt\" includes itself");
  EXPECT_EQ(error_in(R"(Include "bad.pbrt")"), folder + R"(bad.pbrt:3:13: expected a number, found "x")");
  EXPECT_EQ(error_in(R"(Include "none.pbrt")"),
            folder + "main.pbrt:1:1: " + folder + "none.pbrt: no such file; --missing skip renders without it");
  EXPECT_EQ(error_in(R"(Import "bad.pbrt")"), folder + "main.pbrt:1:1: Import must come after WorldBegin");
  EXPECT_EQ(error_in(R"(WorldBegin Import "open.pbrt")"),
            folder +
                "main.pbrt:1:12: the end of the imported file has no matching begin (the innermost open block begins "
                "at line 1)");
  EXPECT_EQ(error_in(R"(WorldBegin AttributeBegin Import "close.pbrt")"),
            folder + "close.pbrt:1:1: AttributeEnd has no matching begin (the innermost open block begins at line 1)");
  for (int i = 0; i < 70; ++i) dir.write(fmt::format("n{}.pbrt", i), fmt::format(R"(Include "n{}.pbrt")", i + 1));
  EXPECT_EQ(error_in(R"(Include "n0.pbrt")"),
            folder + "n62.pbrt:1:1: files include each other more than 64 levels deep");
}

// Fractals include the same files many times: the limit is on their bytes, not on their number.
TEST(Pbrt, ManyInclusions) {
  const auto times = [](int n, const std::string& text) {
    std::string result;
    for (int i = 0; i < n; ++i) result += text;
    return result;
  };
  const FileReader files = [&](const std::filesystem::path& path) -> std::string {
    if (path == "a")
      return times(50, R"(Include "b"
)");
    if (path == "b")
      return times(50, R"(Include "c"
)");
    return "Translate 1 0 0\n";
  };
  const std::string text = "WorldBegin\n" + times(41, R"(Include "a"
)") + R"(Shape "sphere")";
  const SceneDescription scene = pbrt::read(text, "", "t.pbrt", method_of_file, files);
  expect_near(image_of(scene.shapes[0].object_to_world, {0, 0, 0}), {102'500, 0, 0});
  EXPECT_EQ(scene.files.size(), 3u);

  pbrt::Context context;
  context.read_file = files;
  pbrt::FileStack stack;
  stack.bytes_left = 1 << 20;
  const std::string name = "t.pbrt";
  const pbrt::DirectiveSink ignore = [](const pbrt::Directive&) {};
  EXPECT_EQ(test::error_text([&] { pbrt::Parser(text, name, stack, ignore, context).parse(); }),
            "a:6:1: the scene includes too many bytes of files");
}

// Seven files, each of which includes the next three times.
TEST(Pbrt, InclusionsThatMultiplyAreBounded) {
  std::size_t reads = 0;
  const FileReader files = [&](const std::filesystem::path& path) {
    ++reads;
    const int level = path.string().back() - '0';
    std::string text;
    for (int i = 0; i < 3 && level < 6; ++i) text += "Include \"f" + std::to_string(level + 1) + "\"\n";
    return text;
  };
  const std::string text = R"(WorldBegin
Include "f0"
Shape "sphere")";
  EXPECT_EQ(pbrt::read(text, "", "t.pbrt", method_of_file, files).shapes.size(), 1u);
  constexpr std::size_t inclusions = (3 * 3 * 3 * 3 * 3 * 3 * 3 - 1) / 2;
  EXPECT_EQ(reads, inclusions + 7) << "the search for the version of the format reads each file once";

  pbrt::Context context;
  context.read_file = files;
  pbrt::FileStack stack;
  stack.repeated_bytes_left = 10 * 4096;
  const std::string name = "t.pbrt";
  const pbrt::DirectiveSink ignore = [](const pbrt::Directive&) {};
  EXPECT_EQ(test::error_text([&] { pbrt::Parser(text, name, stack, ignore, context).parse(); }),
            "f3:2:1: files that were included before are included again, more than 1024 MiB together");
}

TEST(Pbrt, DeepNestingIsAnError) {
  std::string text = "WorldBegin ";
  for (int i = 0; i < 5000; ++i) text += "AttributeBegin\n";
  EXPECT_EQ(error_of(text), "t.pbrt:4097:1: blocks are nested more than 4096 levels deep");
}

TEST(Pbrt, WorkOfTheWholeSceneIsBounded) {
  const auto error_in = [](const std::string& text, std::size_t spectrum_bytes, double triangles) {
    pbrt::Context context;
    context.read_file = [](const std::filesystem::path&) { return "400 1 500 2"; };
    context.spectrum_bytes_left = spectrum_bytes;
    context.subdivided_triangles_left = triangles;
    pbrt::Assembler assembler(context);
    pbrt::FileStack files;
    const std::string name = "t.pbrt";
    const pbrt::DirectiveSink build = [&](pbrt::Directive d) { assembler.execute(std::move(d)); };
    return test::error_text([&] { pbrt::Parser("WorldBegin\n" + text, name, files, build, context).parse(); });
  };
  const std::string
      light = R"(LightSource "point" "spectrum I" "a.spd"
)",
      surface =
          R"(Shape "loopsubdiv" "integer levels" 2 "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]
)";
  EXPECT_EQ(error_in(light + light + surface + surface, 22, 32), "no error");
  EXPECT_EQ(error_in(light + light, 21, 0),
            R"(t.pbrt:3:21: parameter "I" of LightSource "point" names a spectrum file, but all uses of spectrum )"
            "files together are too large");
  EXPECT_EQ(error_in(surface + surface, 0, 31),
            R"(t.pbrt:3:20: parameter "levels" of Shape "loopsubdiv" would make more than 67 million triangles of the )"
            "scene's subdivision surfaces");
}

TEST(Pbrt, CountsAreBounded) {
  std::string parameters = R"(Film "rgb")", defaults;
  for (int i = 0; i < 1001; ++i)
    parameters += R"(
"float x" 1)";
  for (int i = 0; i < 4097; ++i)
    defaults += R"(Attribute "shape" "float x" 1
)";
  EXPECT_EQ(error_of(parameters), "t.pbrt:1002:1: a directive has more than 1000 parameters");
  EXPECT_EQ(error_of(defaults), "t.pbrt:4097:1: more than 4096 defaults are set for shape");
  std::string numbers;
  for (int i = 0; i < 40'000; ++i) numbers += " 1";
  EXPECT_EQ(error_of(R"(Attribute "shape" "float x" [)" + numbers + R"(]
Attribute "shape" "float y" [)" +
                     numbers + "]"),
            "t.pbrt:2:1: the defaults that are set for shape have more than 256 KiB of values");
}

TEST(Pbrt, OtherExtensionsAreErrors) { EXPECT_THROW(read_scene("scene.xml"), Error); }

TEST(Pbrt, WarnsOncePerKind) {
  const auto scene = read(
      R"(Option "disablepixeljitter" true
Option "disablepixeljitter" true
Sampler "sobol" "integer frob" 1
WorldBegin
Identity
Identity
Shape "sphere" "float size" 1 "float radius" 1 "float radius" 2
Shape "sphere" "float size" 1
Shape "disk" "float size" 1
TransformBegin TransformEnd
WorldEnd
CoordSysTransform "none" CoordSysTransform "none")");
  std::vector<std::string> messages;
  for (const auto& w : scene.warnings)
    messages.push_back(fmt::format("{}:{} {}", w.location.line, w.location.column, w.message));
  const std::vector<std::string> expected = {
      R"(1:1 Option "disablepixeljitter" is not used by Lanthorn: ignored (and 1 more like it))",
      R"(3:17 parameter "frob" of Sampler "sobol" is not used by Lanthorn: ignored)",
      R"(7:16 parameter "size" of Shape "sphere" is not used by Lanthorn: ignored (and 1 more like it))",
      R"(7:31 parameter "radius" of Shape "sphere" is given twice: the last value is used)",
      R"(9:14 parameter "size" of Shape "disk" is not used by Lanthorn: ignored)",
      "10:1 TransformBegin and TransformEnd are read as AttributeBegin and AttributeEnd",
      "11:1 WorldEnd has no meaning in pbrt-v4: ignored",
      R"(12:1 there is no coordinate system "none": the transform does not change (and 1 more like it))"};
  EXPECT_EQ(messages, expected);
  EXPECT_EQ(std::get<description::Sphere>(scene.shapes[0].geometry).radius, 2);
}

// Counts for the scenes that the other tests use.
struct SceneCounts {
  const char* file;
  std::size_t shapes, triangles, patches, lights, area_lights, materials, instances, warnings;
};

void expect_counts(const std::filesystem::path& folder, const SceneCounts& c) {
  SCOPED_TRACE(c.file);
  const SceneDescription scene = read_scene(folder / c.file);
  std::size_t triangles = 0, patches = 0;
  const auto count = [&](const std::vector<description::Shape>& shapes) {
    for (const auto& shape : shapes) {
      if (const auto* mesh = std::get_if<description::TriangleMesh>(&shape.geometry))
        triangles += mesh->triangles.size();
      if (const auto* mesh = std::get_if<description::BilinearMesh>(&shape.geometry)) patches += mesh->patches.size();
    }
  };
  count(scene.shapes);
  for (const auto& object : scene.objects) count(object.shapes);
  EXPECT_EQ(scene.shapes.size(), c.shapes);
  EXPECT_EQ(triangles, c.triangles);
  EXPECT_EQ(patches, c.patches);
  EXPECT_EQ(scene.lights.size(), c.lights);
  EXPECT_EQ(scene.area_lights.size(), c.area_lights);
  EXPECT_EQ(scene.materials.size(), c.materials);
  EXPECT_EQ(scene.instances.size(), c.instances);
  EXPECT_EQ(scene.warnings.size(), c.warnings);
}

const std::filesystem::path conformance_scenes = LANTHORN_SOURCE_DIR "/tests/conformance/scenes";

TEST(PbrtScenes, Conformance) {
  const std::vector<SceneCounts> scenes = {{"c01-furnace.pbrt", 4, 0, 0, 1, 0, 5, 0, 0},
                                           {"c02-cornell.pbrt", 12, 22, 5, 0, 1, 6, 0, 0},
                                           {"c03-cornell-spheres.pbrt", 8, 12, 0, 0, 1, 7, 0, 0},
                                           {"c04-cornell-glossy.pbrt", 8, 12, 0, 0, 1, 8, 0, 0},
                                           {"c05-ring.pbrt", 3, 2050, 0, 0, 1, 4, 0, 0},
                                           {"c06-lamp.pbrt", 9, 10, 0, 0, 1, 8, 0, 0},
                                           {"c07-pool.pbrt", 6, 18440, 0, 1, 1, 4, 0, 0},
                                           {"c08-environment.pbrt", 4, 2, 0, 1, 0, 5, 0, 0},
                                           {"c09-textures.pbrt", 9, 16, 0, 0, 1, 11, 0, 0},
                                           {"c10-lights.pbrt", 7, 10, 0, 4, 0, 6, 0, 0},
                                           {"c11-dof.pbrt", 9, 12, 0, 0, 1, 8, 0, 0},
                                           {"c12-instances.pbrt", 6, 12300, 0, 0, 1, 7, 3, 0},
                                           {"c13-fog.pbrt", 8, 24, 0, 0, 1, 7, 0, 0},
                                           {"c14-prism.pbrt", 3, 12, 0, 1, 1, 4, 0, 0},
                                           {"c15-layers.pbrt", 11, 12, 0, 0, 1, 10, 0, 0},
                                           {"c16-motion.pbrt", 8, 12, 0, 0, 1, 7, 0, 0}};
  for (const SceneCounts& scene : scenes) expect_counts(conformance_scenes, scene);
}

TEST(PbrtScenes, Assets) {
  const auto folder = test::shared_dir("assets");
  if (!folder) GTEST_SKIP() << "no ../shared";
  const std::vector<SceneCounts> scenes = {{"coffee/scene-v4.pbrt", 23, 235271, 0, 0, 3, 9, 0, 0},
                                           {"cornell-box/scene-v4.pbrt", 8, 36, 0, 0, 1, 9, 0, 0},
                                           {"veach-bidir/scene-v4.pbrt", 14, 11544, 0, 0, 2, 5, 0, 0},
                                           {"veach-mis/scene-v4.pbrt", 9, 52, 0, 0, 3, 7, 0, 0},
                                           {"volumetric-caustic/scene-v4.pbrt", 8, 14, 0, 0, 1, 9, 0, 0},
                                           {"water-caustic/scene-v4.pbrt", 10, 103487, 0, 0, 1, 10, 0, 0}};
  for (const SceneCounts& scene : scenes) expect_counts(*folder, scene);
}

TEST(PbrtScenes, MotionAndOptionsOfConformanceScenes) {
  const SceneDescription scene = read_scene(conformance_scenes / "c16-motion.pbrt");
  EXPECT_EQ(scene.view.film.width, 128);
  EXPECT_EQ(scene.view.film.imaging_ratio, 1);
  EXPECT_EQ(scene.view.filter.kind, description::FilterKind::box);
  EXPECT_EQ(scene.view.filter.radius, Vec2(0.5f, 0.5f));
  EXPECT_EQ(std::get<description::PerspectiveCamera>(scene.view.camera.node).fov, 36);
  EXPECT_EQ(scene.hints.integrator, "volpath");
  EXPECT_EQ(scene.hints.max_depth, 24);
  EXPECT_EQ(scene.hints.pixel_samples, 16384);
  const AnimatedTransform& moving = scene.shapes[6].object_to_world;
  EXPECT_TRUE(moving.is_moving());
  expect_near(moving.start.point({0, 0, 0}), {-0.5f, 0.4f, 0});
  expect_near(moving.end.point({0, 0, 0}), {0.3f, 0.7f, 0});
}

}  // namespace
}  // namespace lanthorn::pbrt_test
