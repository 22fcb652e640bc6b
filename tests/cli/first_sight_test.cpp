// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A new user's first minute with the program.
#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "cli_fixture.h"
#include "support/gltf_writer.h"

namespace lanthorn::first_sight_test {
namespace {

class FirstSight : public Cli {};

TEST_F(FirstSight, ThePictureIsThereAfterTheFirstPass) {
  ChildProcess child(LANTHORN_PROGRAM,
                     {"render", "tiny.pbrt", "-i", "path", "-r", "64x64", "-p", "1000000", "--preview", "0.01s", "-o",
                      "a.exr", "-o", "a.state"},
                     dir_.path());
  for (int i = 0; i < 3000 && !fs::exists(path("a.exr")) && !child.has_ended(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(fs::exists(path("a.exr")));
  EXPECT_FALSE(child.has_ended());
  EXPECT_FALSE(fs::exists(path("a.state"))) << "a state is no picture";
  const std::uint64_t first = metadata_of("a.exr")["passes"];
  EXPECT_GE(first, 1u);
  child.send(SIGTERM);
  EXPECT_EQ(child.wait().exit_code, 0);
  EXPECT_GE(metadata_of("a.exr")["passes"].get<std::uint64_t>(), first);
}

TEST_F(FirstSight, ThePictureIsWrittenAtDoublingTimes) {
  ChildProcess child(LANTHORN_PROGRAM,
                     {"render", "tiny.pbrt", "-i", "path", "-r", "16x16", "-p", "100000000", "--preview", "0.05s", "-o",
                      "a.exr", "-t", "2s", "--checkpoint", "none"},
                     dir_.path());
  int writings = 0;
  ino_t last = 0;
  while (!child.has_ended()) {
    struct stat file {};
    if (stat(path("a.exr").c_str(), &file) == 0 && file.st_ino != last) {
      last = file.st_ino;
      ++writings;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_EQ(child.wait().exit_code, 0);
  // Written after about 0, .05, .1, .2, .4, .8 and 1.6 seconds and at the end; a busy machine misses some.
  EXPECT_GE(writings, 2);
  EXPECT_LE(writings, 9);
}

TEST_F(FirstSight, PicturesThatAreTooBrightSayHowToSeeThem) {
  const Words words{"render", "tiny.pbrt", "-i", "path", "-r", "16x16", "-p", "4", "-o", "a.png"};
  EXPECT_TRUE(contains(run(words + Words{"--exposure", "8"}).err, "are brighter than white: --exposure "));
  EXPECT_FALSE(contains(run(words + Words{"--exposure", "-8"}).err, "brighter than white"));
  EXPECT_FALSE(
      contains(run(words + Words{"--exposure", "8", "--view-transform", "filmic"}).err, "brighter than white"));
}

TEST_F(FirstSight, PicturesThatAreTooDarkSayHowToSeeThem) {
  const Words words{"render", "tiny.pbrt", "-i", "path", "-r", "16x16", "-p", "4", "-o", "a.png"};
  const std::string said = run(words + Words{"--exposure", "-16"}).err, before = "nearly black: --exposure ";
  ASSERT_TRUE(contains(said, before)) << said;
  const std::string exposure = said.substr(said.find(before) + before.size(), 3);
  EXPECT_FALSE(contains(run(words + Words{"--exposure", exposure}).err, "nearly black"));
  // A room without light is black, and no exposure changes that.
  dir_.write("dark.pbrt", R"(WorldBegin
Shape "sphere"
)");
  EXPECT_FALSE(contains(run({"render", "dark.pbrt", "-r", "16x16", "-p", "1", "-o", "b.png"}).err, "nearly black"));
}

// The brightest value of a PNG, 1 for white.
float brightest(const fs::path& path) {
  const Image image = read_image(path, ColorEncoding::linear);
  return *std::max_element(image.pixels.begin(), image.pixels.end());
}

// A floor under a lamp of 0.01 cd, which would be invisible at exposure 0.
const char* const dim_model = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
  "nodes": [{"mesh": 0}, {"translation": [0, 0, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 0.01}]}},
  "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]})";

TEST_F(FirstSight, ModelsWithoutAnExposureGetOne) {
  dir_.write("dim.gltf", dim_model);
  const Words words{"render", "dim.gltf", "-i", "path", "-r", "16x16", "-p", "2", "-o", "a.png", "-o", "a.state"};
  const std::string said = succeed(words).out;
  EXPECT_GT(brightest(path("a.png")), 0.8f);
  const std::size_t at = said.find("a.png: --exposure ");
  ASSERT_NE(at, said.npos) << said;
  // The reported exposure reproduces the picture, and so does a state.
  const std::string stops = said.substr(at + 18, said.find(' ', at + 18) - at - 18);
  EXPECT_TRUE(contains(said, stops + " --view-transform highlights, measured from the picture")) << said;
  succeed({"merge", "a.state", "-o", "merged.png", "--reproducible"});
  succeed(
      {"merge", "a.state", "-o", "same.png", "--reproducible", "--exposure", stops, "--view-transform", "highlights"});
  expect_equal_files("merged.png", "same.png");
  EXPECT_FALSE(contains(succeed(words + Words{"--exposure", "0"}).out, "--exposure"));
  EXPECT_LT(brightest(path("a.png")), 0.2f);
}

// A huge exposure means that the camera sees next to nothing: a message says why.
TEST_F(FirstSight, TheReasonForAHugeExposureIsSaid) {
  const auto said = [&](const std::string& file, const std::string& text) {
    dir_.write(file, text);
    return run({"render", file, "-i", "path", "-r", "16x16", "-p", "16", "--exposure", "auto", "-o", "a.png"}).err;
  };
  const std::string huge = "a.png: the camera sees next to nothing, so that an exposure of ";
  std::string faint = dim_model;
  faint.replace(faint.find("0.01}"), 4, "1e-7");
  const std::string of_faint = said("faint.gltf", faint);
  EXPECT_TRUE(contains(of_faint, huge) && contains(of_faint, "the lights are faint, or far")) << of_faint;
  EXPECT_FALSE(contains(said("dim.gltf", dim_model), huge));
  // A lamp that faces away from the floor lights it by way of a distant, nearly black ceiling.
  const std::string of_hidden = said("hidden.pbrt",
                                     R"(LookAt 0 1 0  0 0 .1  0 0 1 Camera "perspective" WorldBegin
AttributeBegin Translate 0 2 0 Rotate -90 1 0 0 AreaLightSource "diffuse" Shape "disk" AttributeEnd
AttributeBegin Translate 0 50 0 Rotate 90 1 0 0 Material "diffuse" "rgb reflectance" [.001 .001 .001] Shape "disk" "float radius" 50 AttributeEnd
Rotate -90 1 0 0 Shape "disk" "float radius" 20
)");
  EXPECT_TRUE(contains(of_hidden, huge) && contains(of_hidden, "no light is in sight")) << of_hidden;
}

// The pixel's colour as a linear display value.
std::vector<float> shown_at(const fs::path& path, int x, int y) {
  const Image image = read_image(path, ColorEncoding::srgb);
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

// An unlit cube beside a light of 54351 cd. The light needs an exposure of -8, but the cube's colour is meant for the
// display.
TEST_F(FirstSight, UnlitColoursAreShownAsTheyAre) {
  const std::string model = LANTHORN_SOURCE_DIR "/tests/scenes/models/unlit-and-lamp.gltf";
  succeed({"render", model, "-i", "path", "-r", "64x48", "-p", "4", "-o", "a.png", "-o", "a.exr", "-o", "a.state"});
  const Image linear = read_image(path("a.exr"));
  const Image emission = *select_layer(linear, "emission");
  int cube = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      if (std::fabs(emission.at(x, y, 0) - 0.8f) > 1e-3f) continue;  // not only the cube
      ++cube;
      const std::vector<float> shown = shown_at(path("a.png"), x, y);
      EXPECT_NEAR(shown[0], 0.8f, 0.005f) << x << " " << y;
      EXPECT_NEAR(shown[1], 0.05f, 0.005f) << x << " " << y;
      EXPECT_NEAR(shown[2], 0.05f, 0.005f) << x << " " << y;
    }
  EXPECT_GT(cube, 20);
  // The same holds for every way to a PNG, and at any exposure.
  succeed({"develop", "a.exr", "developed.png", "--exposure", "auto"});
  succeed({"merge", "a.state", "-o", "merged.png"});
  succeed({"merge", "a.state", "-o", "bright.png", "--exposure", "3", "--view-transform", "filmic"});
  const Image first = read_image(path("a.png")), bright = read_image(path("bright.png"));
  EXPECT_EQ(read_image(path("developed.png")).pixels, first.pixels);
  EXPECT_EQ(read_image(path("merged.png")).pixels, first.pixels);
  for (int x = 0; x < 64; ++x)
    if (std::fabs(emission.at(x, 24, 0) - 0.8f) <= 1e-3f) {
      EXPECT_EQ(bright.at(x, 24, 0), first.at(x, 24, 0));
    }
}

// If a picture shows nothing, the program says why.
TEST_F(FirstSight, BlackPicturesSayWhy) {
  const auto reason = [&](const std::string& scene, const Words& more = {}) {
    dir_.write("black.pbrt", scene);
    const std::string said =
        run(Words{"render", "black.pbrt", "-i", "path", "-r", "16x16", "-p", "2", "-o", "b.png"} + more).err;
    const std::string before = "b.png: the picture is black: ";
    const std::size_t at = said.find(before);
    return at == said.npos ? "" : said.substr(at + before.size(), said.find('\n', at) - at - before.size());
  };
  const std::string look = R"(LookAt 0 0 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
)";
  const std::string lamp = R"(LightSource "point" "point3 from" [0 5 -5]
)",
                    ball = R"(Shape "sphere"
)";
  EXPECT_EQ(reason(test::file_bytes(LANTHORN_SOURCE_DIR "/tests/scenes/models/nolight.pbrt")),
            "the scene has no light");
  EXPECT_EQ(reason(look + lamp + ball), "");
  EXPECT_EQ(reason(look + ball), "the scene has no light");
  EXPECT_EQ(reason(look + R"(LightSource "point" "float scale" 0
)" + ball),
            "the scene's light has no power");
  EXPECT_EQ(reason(look + R"(LightSource "point" "float scale" 0
LightSource "infinite" "float scale" 0
)" + ball),
            "none of the scene's lights has any power");
  EXPECT_EQ(reason(R"(Film "rgb" "float iso" 1e-44
)" + look + lamp + ball),
            "the film's exposure is 0");
  EXPECT_EQ(reason(look + lamp + "Translate 0 9 0\n" + ball),
            "no surface is in the camera's view; --look-at places the camera");
  EXPECT_EQ(
      reason(look + lamp + ball + "Translate 0 0 -5\n" + ball),
      "the camera is inside of closed surfaces that keep the light out (black.pbrt:7:1: the one in the middle of the "
      "picture); --look-at places the camera");
  EXPECT_EQ(reason(look + lamp + ball, {"--look-at", "0,0,0.5,0,0,1,0,1,0"}).substr(0, 40),
            "the camera is inside of closed surfaces ");
  EXPECT_EQ(reason(look + R"(LightSource "point" "point3 from" [0 0 5]
Shape "sphere" "float radius" 3
)"),
            "no light reaches what the camera sees");
  EXPECT_EQ(reason(look + lamp + ball, {"--quiet"}), "");
}

TEST_F(FirstSight, AnimationsAreShownAtATime) {
  test::GltfWriter file;
  file.mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
  file.node({{"mesh", 0}});
  const nlohmann::json sampler = {{"input", file.accessor<float>({0, 2}, 1)},
                                  {"output", file.accessor<float>({0, 0, 0, 8, 0, 0}, 3)}};
  file.add("animations", {{"samplers", {sampler}},
                          {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
  dir_.write("moves.gltf", file.text());
  EXPECT_TRUE(contains(succeed({"info", "moves.gltf"}).out, "bounds     (0, 0, 0) to (1, 1, 0)"));
  EXPECT_TRUE(contains(succeed({"info", "moves.gltf", "--at", "1.5"}).out, "bounds     (6, 0, 0) to (7, 1, 0)"));
  for (const Words& frame : {Words{"--at", "frame=36@24"}, Words{"--at", "frame=45@30"}})
    EXPECT_TRUE(contains(succeed(Words{"info", "moves.gltf"} + frame).out, "bounds     (6, 0, 0) to (7, 1, 0)"));
  refuse({"info", "moves.gltf", "--at", "frame=24"}, "--at frame=24: expected seconds such as 1.5, or a frame such as");
  refuse({"info", "tiny.pbrt", "--at", "1"}, "tiny.pbrt: --at, --frames: only glTF files have animations");
  // Another time gives another scene.
  const Words words{"render", "moves.gltf", "-i", "path", "-r", "8x8", "-p", "1", "--at"};
  succeed(words + Words{"0", "-o", "a.state"});
  refuse(words + Words{"1", "-o", "b.state", "--resume", "a.state"}, "another");
}

TEST_F(FirstSight, ExposureIsMeasuredForPbrtOnDemandAlone) {
  const Words words{"render", "tiny.pbrt", "-i", "path", "-r", "16x16", "-p", "2", "-o", "a.png"};
  EXPECT_FALSE(contains(succeed(words).out, "--exposure"));
  EXPECT_TRUE(contains(succeed(words + Words{"--exposure", "auto"}).out, "a.png: --exposure "));
  EXPECT_FALSE(contains(succeed(words + Words{"--exposure", "auto", "-q"}).out, "--exposure"));
}

TEST_F(FirstSight, ScenesThatWillBeBlackSayWhy) {
  dir_.write("dark.pbrt", R"(WorldBegin
Shape "sphere"
)");
  dir_.write("empty.pbrt", R"(WorldBegin
LightSource "infinite"
)");
  EXPECT_TRUE(
      contains(succeed({"info", "dark.pbrt"}).out, "dark.pbrt: the scene has no light: the picture will be black"));
  EXPECT_TRUE(contains(succeed({"info", "empty.pbrt"}).out, "empty.pbrt: the scene has no shapes"));
  EXPECT_TRUE(contains(run({"render", "dark.pbrt", "-r", "8x8", "-p", "1", "-o", "a.exr"}).err, "has no light"));
  EXPECT_FALSE(contains(succeed({"info", "tiny.pbrt"}).out, "the scene has no"));
}

TEST_F(FirstSight, LightThatAMethodHardlyFindsIsNamed) {
  const std::string lit = R"(WorldBegin
Material "diffuse"
Shape "sphere" "float radius" 3
)";
  dir_.write("glass.pbrt", lit + R"(LightSource "point"
Material "dielectric"
Shape "sphere" "float radius" .5
)");
  dir_.write("bare.pbrt", lit + R"(LightSource "point"
)");
  const Words words{"-r", "8x8", "-p", "1", "-o", "a.exr", "-i"};
  const std::string hint = "comes by glass or mirrors from small lights";
  EXPECT_TRUE(contains(run(Words{"render", "glass.pbrt"} + words + Words{"path"}).err, hint));
  EXPECT_FALSE(contains(run(Words{"render", "glass.pbrt"} + words + Words{"path", "-q"}).err, hint));
  EXPECT_FALSE(contains(run(Words{"render", "glass.pbrt"} + words + Words{"probppm"}).err, hint));
  EXPECT_FALSE(contains(run(Words{"render", "bare.pbrt"} + words + Words{"path"}).err, hint));
}

TEST_F(FirstSight, ALimitOfPathsIsPartOfThePicture) {
  const Words words{"render", "tiny.pbrt", "-i", "path", "-r", "8x8", "-p", "2", "-o", "a.exr", "-o", "a.state"};
  succeed(words + Words{"--clamp", "0.01"});
  EXPECT_FLOAT_EQ(metadata_of("a.exr")["clamp"].get<float>(), 0.01f);
  refuse({"render", "tiny.pbrt", "-i", "path", "-r", "8x8", "-p", "4", "--resume", "a.state", "-o", "b.exr"}, "clamp");
  refuse(words + Words{"--clamp", "0"}, "--clamp 0: expected a number above 0");
}

TEST_F(FirstSight, AllMissingFilesAreNamedAtOnce) {
  dir_.write("a.pbrt", tiny_scene + std::string(R"(Texture "t" "spectrum" "imagemap" "string filename" "no.png"
Material "diffuse" "texture reflectance" "t"
Shape "plymesh" "string filename" "no.ply"
Shape "sphere" "float radius" .1
LightSource "infinite" "string filename" "sky.exr"
)"));
  const std::string said = refuse({"info", "a.pbrt"}, "3 files are missing, the first of them here: ");
  EXPECT_TRUE(said.starts_with("lanthorn: a.pbrt:18:")) << said;
  for (const char* name : {R"("no.png")", R"("no.ply")", R"("sky.exr")", "--missing skip"})
    EXPECT_TRUE(contains(said, name)) << said;
  const Ending ending = run({"render", "a.pbrt", "--missing", "skip", "-i", "path", "-p", "1", "-o", "a.exr"});
  EXPECT_EQ(ending.exit_code, 0) << ending.err;
  for (const char* name : {"a.pbrt:18:", "3 files are missing", R"("no.png")", R"("no.ply")", R"("sky.exr")"})
    EXPECT_TRUE(contains(ending.err, name)) << ending.err;
  refuse({"info", "a.pbrt", "--missing", "perhaps"}, "--missing");
}

TEST_F(FirstSight, TheColourModeIsSaid) {
  const auto said = [&](const std::string& material, const Words& more) {
    dir_.write("a.pbrt", tiny_scene + ("Material " + material + R"(
Shape "sphere" "float radius" .1
)"));
    return run(Words{"render", "a.pbrt", "-r", "8x8", "-p", "1", "-o", "a.exr"} + more).err;
  };
  const std::string gold = R"("conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k")";
  const std::string flint = R"("dielectric" "spectrum eta" "glass-F11")";
  EXPECT_TRUE(contains(said(gold, {}), "color rgb: nothing in the scene disperses light"));
  EXPECT_TRUE(contains(said(flint, {}), "color spectral: glass disperses light"));
  EXPECT_FALSE(contains(said(gold, {"--color", "rgb"}), "color rgb"));
  EXPECT_FALSE(contains(said(gold, {"-q"}), "color rgb"));
  const std::string all = said(gold, {});
  EXPECT_FALSE(contains(all, "\\x")) << "lines end with line feeds: " << all;
}

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++count;
  return count;
}

TEST_F(FirstSight, AutoInPlaceOfTheFilesIntegratorIsSaidOnce) {
  dir_.write("sppm.pbrt", std::string(R"(Integrator "sppm" "integer maxdepth" 9
)") + tiny_scene);
  dir_.write("vcm.pbrt", std::string(R"(Integrator "vcm"
)") + tiny_scene);
  const std::string line = R"(
method auto: in place of pbrt's "sppm", which the file names (-i sppm: that method)
)";
  const auto said = [&](const std::string& scene, const Words& more) {
    return "\n" + succeed(Words{"render", scene, "-r", "8x8", "-p", "1"} + more).err;
  };
  const Words one{"-o", "a.exr"};
  EXPECT_EQ(count_of(said("sppm.pbrt", one), line), 1);
  EXPECT_EQ(metadata_of("a.exr")["integrator"], "auto");
  EXPECT_EQ(metadata_of("a.exr")["max_depth"], 18);
  EXPECT_EQ(count_of(said("sppm.pbrt", {"--turntable", "3", "-o", "a.#.exr"}), line), 1);
  for (const Words& more : {one + Words{"-q"}, one + Words{"-i", "sppm"}, one + Words{"-i", "path"}})
    EXPECT_FALSE(contains(said("sppm.pbrt", more), "method auto"));
  EXPECT_EQ(metadata_of("a.exr")["integrator"], "path");
  EXPECT_FALSE(contains(said("tiny.pbrt", one), "method auto"));
  EXPECT_EQ(metadata_of("a.exr")["integrator"], "auto");
  EXPECT_FALSE(contains(said("vcm.pbrt", one), "method auto"));
  EXPECT_EQ(metadata_of("a.exr")["integrator"], "vcm");
  for (const std::string scene : {"sppm.pbrt", "tiny.pbrt"})
    EXPECT_TRUE(contains(succeed({"info", scene}).out, "\nmethod     auto\n")) << scene;
  EXPECT_TRUE(contains(succeed({"info", "vcm.pbrt"}).out, "\nmethod     vcm\n"));
}

}  // namespace
}  // namespace lanthorn::first_sight_test
