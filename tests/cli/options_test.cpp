// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Command-line input: options in any order, numbers with units, typing errors; and files that must not be overwritten.
#include <sys/stat.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "cli_fixture.h"
#include "lanthorn/image.h"
#include "lanthorn/image_file.h"
#include "render/state.h"

namespace lanthorn::options_test {
namespace {

class CliOptions : public Cli {
 protected:
  /// One pass of `path`, small and quiet.
  static Words quick(const Words& more) {
    return Words{"render", "tiny.pbrt", "-i", "path", "-p", "1", "-r", "8x8", "-q", "--reproducible"} + more;
  }
  void copy(const std::string& from, const std::string& to) const {
    fs::create_directories(path(to).parent_path());
    fs::copy_file(path(from), path(to), fs::copy_options::overwrite_existing);
  }
  /// Renders a scene of 16 x 16 pixels and a crop of it, in two passes. `rounding`: tolerance relative to a value.
  /// Error estimates are excluded: they average over neighbouring pixels, which a crop lacks.
  void expect_pixels_of_whole(const Words& words, float rounding = 0) const {
    SCOPED_TRACE(testing::PrintToString(words));
    succeed(words + Words{"-p", "2", "-o", "whole.exr"});
    succeed(words + Words{"-p", "2", "-o", "part.exr", "--crop", "3,5,11,12"});
    const Image whole = read_image(path("whole.exr")), part = read_image(path("part.exr"));
    ASSERT_EQ(part.channels, whole.channels);
    ASSERT_EQ(part.width, 8);
    ASSERT_EQ(part.height, 7);
    int different = 0;
    for (int y = 0; y < part.height; ++y)
      for (int x = 0; x < part.width; ++x)
        for (std::size_t c = 0; c < part.channel_count(); ++c) {
          const std::string& channel = part.channels[c];
          if (channel.starts_with("error.") || channel.starts_with("bias.") || channel.starts_with("noise.bias."))
            continue;
          const float a = part.at(x, y, c), b = whole.at(x + 3, y + 5, c);
          const bool equal = std::fabs(a - b) <= rounding * std::fabs(b) || (std::isnan(a) && std::isnan(b));
          different += equal ? 0 : 1;
        }
    EXPECT_EQ(different, 0);
  }
};

TEST_F(CliOptions, StandInAnyOrder) {
  succeed({"render", "-o", "a.exr", "tiny.pbrt", "-q", "-i", "path", "-p", "1"});
  succeed({"render", "-i", "path", "--set", "roulette-depth=5", "tiny.pbrt", "-p", "1", "-q", "-o", "b.png", "-o",
           "b.exr"});
  succeed({"render", "-q", "-p", "1", "-i", "path", "--set", "roulette-depth=5", "--set", "guide=none", "-o", "c.state",
           "tiny.pbrt"});
  succeed({"photons", "-o", "a.ply", "-n", "1k", "tiny.pbrt"});
  succeed({"merge", "-o", "d.exr", "c.state"});
  succeed({"compare", "--runs", "a.exr", "b.exr", "a.exr", "b.exr"});
  succeed({"info", "--json", "tiny.pbrt"});
  EXPECT_EQ(files(), (Words{"a.exr", "a.ply", "b.exr", "b.png", "c.state", "d.exr", "tiny.pbrt"}));
}

TEST_F(CliOptions, TakeNumbersWithUnits) {
  const Words base{"render", "tiny.pbrt", "-r", "8x8", "-q", "--force", "-o", "a.state"};
  const auto identity = [&](const Words& more) {
    succeed(base + more);
    return load_state(path("a.state")).record.identity;
  };
  EXPECT_EQ(identity({"-p", "1", "--photons", "0.5k"}).photons, 500u);
  EXPECT_EQ(identity({"-p", "1", "--photons", "0.001M"}).photons, 1000u);
  EXPECT_EQ(identity({"-p", "1", "--photons", "2e3"}).photons, 2000u);
  EXPECT_EQ(identity({"-p", "1", "-i", "path", "--seed", "18446744073709551615"}).seed, 18446744073709551615u);
  EXPECT_EQ(identity({"-p", "0.003k", "-i", "path"}).integrator, "path");
  EXPECT_EQ(load_state(path("a.state")).pass_count(), 3u);
  succeed(base + Words{"-i", "path", "--pass-range", "1k:1.002k"});
  EXPECT_EQ(load_state(path("a.state")).passes, (std::vector<PassRange>{{1000, 1002}}));
  succeed(base + Words{"-i", "path", "--time", "0.001m", "--checkpoint", "10m", "--memory", "64MiB"});
}

TEST_F(CliOptions, SayWhatNumbersTheyExpect) {
  const std::map<std::string, std::pair<Words, std::string>> wrong{
      {"--photons", {{"1Q", "-1", "0", "1.5", "1e30", "", "nan", "1 k"}, "expected a count of 1 or more, such as"}},
      {"--passes", {{"0", "5G"}, "expected a count from 1 to 4294967295, such as 500000, 200k or 1M"}},
      {"--seed", {{"-1", "18446744073709551616"}, "expected a count of 0 or more"}},
      {"--threads", {{"1M"}, "expected a count from 0 to 65536"}},
      {"--time", {{"5q", "0", "-1s", "nan", "inf"}, "expected a duration such as 30s, 5m or 2h"}},
      {"--checkpoint", {{"10x"}, "expected a duration such as 30s, 5m or 2h"}},
      {"--memory", {{"2Q", "0", "-1G"}, "expected a size such as 512M or 2G"}},
      {"--exposure", {{"nan", "-inf", "1k", "65"}, "expected a number from -64 to 64"}},
      {"--color", {{"spctral"}, "expected rgb or spectral; did you mean spectral?"}}};
  for (const auto& [option, values_and_text] : wrong)
    for (const std::string& value : values_and_text.first)
      refuse({"render", "tiny.pbrt", "-o", "a.exr", option + "=" + value},
             value.empty() ? option : option + " " + value + ": " + values_and_text.second);
  for (const char* limit : {"--max-mse", "--epsilon", "--clamp"})
    refuse({"compare", "a.exr", "b.exr", std::string(limit) + "=nan"}, std::string(limit) + " nan: expected a number");
  refuse({"render", "tiny.pbrt", "-i", "probppm", "--set", "radius=nan", "-o", "a.exr"}, "--set radius=nan");
}

TEST_F(CliOptions, SlipsOfTheHandAreAnsweredWithTheNearestName) {
  const auto expect = [&](const Words& words, const std::string& meant) {
    refuse(words, "did you mean " + meant + "?");
  };
  expect({"rendr", "tiny.pbrt"}, "render");
  expect({"mrege", "a.state", "-o", "a.exr"}, "merge");
  expect({"--vresion"}, "--version");
  expect(quick({"--resoluton", "8x8"}), "--resolution");
  expect({"render", "--resoluton", "8x8", "tiny.pbrt"}, "--resolution");
  expect(quick({"--max-dpeth=3"}), "--max-depth");
  expect({"compare", "a.exr", "b.exr", "--max-msee", "1"}, "--max-mse");
  const auto method = [](const std::string& name, const std::string& set) {
    return Words{"render", "tiny.pbrt", "-o", "a.exr", "-i", name, "--set", set};
  };
  expect(method("probpm", "alpha=1"), "probppm");
  refuse(method("auto", "alpha=1"), "'auto' has no parameters; -i selects another method");
  expect({"list", "ptah"}, "path");
  expect(quick({"--set", "roulete-depth=3"}), "roulette-depth");
  expect(quick({"--set", "guide=photon"}), "photons");
  expect(method("probppm", "kernel=epanechnikow"), "epanechnikov");
  expect(method("sppm", "schedule=hachisuk"), "hachisuka");
  expect(method("mlt", "over=bpt"), "bdpt");
  expect(method("vcm", "volume=point+beems"), "beams");
  for (const char* other : {"volume=short-beams", "volume=points", "volume=point+", "volume="})
    refuse(method("bpm", other), "expected path, or one or more of point, beam, photon-beam, beams, joined by +");
  EXPECT_FALSE(contains(refuse(quick({"--nosuch"}), "unknown option --nosuch"), "did you mean"));
  EXPECT_FALSE(contains(refuse({"nosuch"}, "unknown subcommand 'nosuch'"), "did you mean"));
  refuse(quick({"more.pbrt"}), "'more.pbrt' was not expected");
  refuse(quick({"-p", "2"}), "--passes was given more than once");
}

TEST_F(CliOptions, OutputsAreNoInputsByAnyName) {
  dir_.write("wall.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n-1 0 -1\n1 0 -1\n1 2 -1\n3 0 1 2\n");
  succeed(quick({"-o", "texture.exr", "-o", "a.png"}));
  std::string scene = tiny_scene;
  scene.insert(scene.find("AttributeBegin"),
               R"(Include "part.pbrt"
Shape "plymesh" "string filename" "wall.ply"
Texture "t" "spectrum" "imagemap" "string filename" "texture.exr"
)");
  dir_.write("part.pbrt", "# nothing\n");
  dir_.write("s.pbrt", scene);
  fs::create_symlink("s.pbrt", path("link.json"));
  fs::create_hard_link(path("s.pbrt"), path("hard.json"));
  fs::create_directory(path("folder"));
  const Words render{"render", "s.pbrt", "-i", "path", "-p", "1", "-q"};
  const auto refuse_render = [&](const Words& more, const std::string& says) { refuse(render + more, says); };
  refuse_render({"-o", "a.exr", "--json", "s.pbrt"}, "--json s.pbrt: is the scene file");
  refuse_render({"-o", "a.exr", "--json", "folder/../s.pbrt"}, "is the scene file");
  refuse_render({"-o", "a.exr", "--json", path("s.pbrt").string()}, "is the scene file");
  refuse_render({"-o", "a.exr", "--json", "link.json"}, "--json link.json: is the scene file");
  refuse_render({"-o", "a.exr", "--json", "hard.json"}, "--json hard.json: is the scene file");
  refuse_render({"-o", "texture.exr"}, "-o texture.exr: is texture.exr, which the scene reads");
  refuse_render({"-o", "a.exr", "--json", "part.pbrt"}, "is part.pbrt, which the scene reads");
  refuse_render({"-o", "a.exr", "-o", "./a.exr"}, "-o ./a.exr: is also the file of -o a.exr");
  refuse_render({"-o", "new.exr", "--json", "folder/../new.exr"}, "is also the file of -o new.exr");
  fs::create_symlink("not-there-yet.exr", path("dangling.exr"));
  refuse_render({"-o", "not-there-yet.exr", "-o", "dangling.exr"}, "is also the file of -o not-there-yet.exr");
  refuse({"photons", "s.pbrt", "-o", "s.pbrt"}, "-o s.pbrt: is the scene file");
  refuse({"photons", "s.pbrt", "-o", "wall.ply"}, "-o wall.ply: is wall.ply, which the scene reads");
  const Words converge{"converge", "s.pbrt", "-i", "path", "-p", "1", "--runs", "2", "--reference", "a.png"};
  refuse(converge + Words{"--plot", "s.pbrt"}, "--plot s.pbrt: is the scene file");
  refuse(converge + Words{"--json", "a.png"}, "--json a.png: is the picture of --reference");
  refuse(converge + Words{"--json", "c.svg", "--plot", "c.svg"}, "is also the file of");
  refuse({"compare", "a.png", "texture.exr", "--json", "a.png"}, "--json a.png: is IMAGE");
  refuse({"compare", "texture.exr", "a.png", "--diff", "a.png"}, "--diff a.png: is REFERENCE");
  const Ending devices = run(render + Words{"-o", "b.exr", "--json", "/dev/null"});
  EXPECT_EQ(devices.exit_code, 0) << devices.err;
  EXPECT_EQ(run(converge + Words{"--json", "/dev/stderr", "-r", "8x8"}).exit_code, 0);
}

TEST_F(CliOptions, WhatCannotBeWrittenIsRefusedBeforeTheFirstPass) {
  fs::create_directory(path("d.exr"));
  fs::create_directory(path("d.ply"));
  // So many passes that an actual render would be noticed.
  const auto refuse_render = [&](const Words& more, const std::string& says) {
    refuse(Words{"render", "tiny.pbrt", "-q", "-p", "1M"} + more, says);
  };
  refuse_render({"-o", "d.exr"}, "-o d.exr: is a folder");
  refuse_render({"-o", "a.exr", "--json", "d.ply"}, "--json d.ply");
  refuse_render({"-o", "a.exr", "--json", "a.png"}, "--json a.png: expected a name that ends in .json");
  refuse_render({"-o", "/proc/a.exr"}, "is not writable");
  refuse_render({"-o", "nosuch/a.exr"}, "there is no folder nosuch");
  const Words photons{"photons", "tiny.pbrt", "-o"};
  refuse(photons + Words{"p.xyz"}, "-o p.xyz: expected a name that ends in .ply");
  refuse(photons + Words{"d.ply"}, "-o d.ply: is a folder");
  const Words converge{"converge", "tiny.pbrt", "--runs", "1M"};
  refuse(converge + Words{"--plot", "c.png"}, "--plot c.png: expected a name that ends in .svg");
  refuse(converge + Words{"--json", "/proc/c.json"}, "is not writable");
  succeed(quick({"-o", "a.exr"}));
  refuse({"compare", "a.exr", "a.exr", "--diff", "d.jpg"}, "--diff d.jpg: expected a name that ends in .png");
  refuse({"compare", "a.exr", "a.exr", "--json", "a.svg"}, "--json a.svg: expected a name that ends in .json");
  ASSERT_EQ(chmod(path("a.exr").c_str(), 0444), 0);
  refuse_render({"-o", "a.exr"}, "-o a.exr: exists and is write-protected");
  succeed(quick({"-o", "a.exr", "--force"}));
}

TEST_F(CliOptions, StatesThatHoldSomethingElseAreNotReplaced) {
  const auto render = [](const Words& more) {
    return Words{"render", "tiny.pbrt", "-i", "path", "-r", "8x8", "-q", "--reproducible"} + more;
  };
  succeed(render({"-p", "3", "-o", "a.state"}));
  const std::string before = bytes("a.state");
  refuse(
      render({"-p", "3", "-o", "a.state", "--seed", "7"}),
      "a.state: holds another render: it differs in --seed (0 and 7); choose another name, or replace it with --force");
  refuse(render({"-p", "2", "-o", "a.state"}), "holds 3 passes of this render, of which 1 would be lost");
  refuse(render({"--pass-range", "3:6", "-o", "a.state"}), "of which 3 would be lost");
  refuse(render({"--time", "1h", "-o", "a.state"}), "go on from it with --resume");
  refuse(render({"-p", "2", "-o", "a.exr", "--checkpoint", "1h"}), "of which 3 would be lost");
  EXPECT_TRUE(bytes("a.state") == before);
  succeed(render({"-p", "3", "-o", "a.state"}));
  EXPECT_TRUE(bytes("a.state") == before);
  succeed(render({"-p", "5", "--resume", "a.state", "-o", "a.state"}));
  succeed(render({"--time", "0.01s", "--resume", "a.state", "-o", "a.state", "--checkpoint", "1h"}));
  EXPECT_GE(load_state(path("a.state")).pass_count(), 5u);
  succeed(render({"-p", "1", "-o", "a.state", "--force"}));
  EXPECT_EQ(load_state(path("a.state")).pass_count(), 1u);

  dir_.write("notes.state", "not a state");
  refuse(render({"-p", "1", "-o", "notes.state"}), "notes.state: exists and cannot be read");
  EXPECT_EQ(bytes("notes.state"), "not a state");
  succeed(render({"-p", "1", "-o", "notes.state", "--force"}));

  succeed(render({"--pass-range", "1:2", "-o", "b.state"}));
  refuse({"merge", "a.state", "b.state", "-o", "b.state"}, "-o b.state: is one of the states to merge");
  succeed({"merge", "a.state", "b.state", "-o", "all.state"});
  succeed({"merge", "b.state", "a.state", "-o", "all.state"});
  refuse({"merge", "a.state", "-o", "all.state"}, "of which 1 would be lost; merge it, too");
  succeed({"merge", "a.state", "-o", "all.state", "--force"});
}

TEST_F(CliOptions, MessagesNameOptions) {
  succeed(quick({"-o", "a.state"}));
  const auto refuse_resume = [&](const Words& more, const std::string& says) {
    refuse(Words{"render", "tiny.pbrt", "-q", "-p", "2", "--resume", "a.state", "-o", "a.exr"} + more, says);
  };
  refuse_resume({"-i", "path", "-r", "9x7"}, "--resolution (8x8 and 9x7)");
  refuse_resume({"-i", "path", "-r", "8x8", "--crop", "1,2,3,4"}, "--crop (0,0,8,8 and 1,2,3,4)");
  refuse_resume({"-i", "light", "-r", "8x8"}, "--integrator (path and light)");
  refuse_resume({"-r", "8x8"}, "--integrator (path and auto)");
  refuse_resume({"-i", "path", "-r", "8x8", "-d", "3"}, "--max-depth (64 and 3)");
  refuse_resume({"-i", "path", "-r", "8x8", "-n", "3k"}, "--photons (100000 and 3000)");
  refuse_resume({"-i", "path", "-r", "8x8", "--set", "roulette-depth=5"}, "--set roulette-depth (");
  std::string cropped = tiny_scene;
  cropped.insert(cropped.find(R"("integer xresolution")"), R"("float cropwindow" [0.2 0.4 0.2 0.4] )");
  dir_.write("cropped.pbrt", cropped);
  refuse({"render", "cropped.pbrt", "-r", "2x1", "-o", "a.exr"}, "--resolution 2x1: the crop window");
}

TEST_F(CliOptions, ReproducibleFilesHoldNoFoldersAndDependOnNone) {
  std::string scene = tiny_scene;
  scene += R"(Include "parts/part.pbrt"
Include ")" +
           path("private/outside.pbrt").string() + "\"\n";
  dir_.write("private/outside.pbrt", "# nothing\n");
  for (const char* folder : {"one", "two/deep"}) {
    dir_.write(std::string(folder) + "/s.pbrt", scene);
    dir_.write(std::string(folder) + "/parts/part.pbrt", "# nothing\n");
  }
  const auto render = [&](const std::string& file, const Words& outputs) {
    Words words{"render", file, "-i", "path", "-p", "1", "-r", "8x8", "-q", "--reproducible"};
    for (const std::string& output : outputs) words = words + Words{"-o", output};
    succeed(words);
  };
  const std::string absolute = path("one/s.pbrt").string();
  render("one/s.pbrt", {"a.exr", "a.png", "a.state"});
  render("./one/../one/s.pbrt", {"b.exr", "b.png", "b.state"});
  render(absolute, {"c.exr", "c.png", "c.state"});
  render("two/deep/s.pbrt", {"d.exr", "d.png", "d.state"});
  for (const std::string extension : {".exr", ".png", ".state"}) {
    for (const std::string other : {"b", "c", "d"}) expect_equal_files("a" + extension, other + extension);
    EXPECT_FALSE(contains(bytes("c" + extension), dir_.path().string())) << extension;
    EXPECT_FALSE(contains(bytes("c" + extension), "private")) << extension;
  }
  EXPECT_EQ(metadata_of("c.exr")["scene"], "s.pbrt");
  const auto names = load_state(path("c.state")).record.identity.files;
  EXPECT_TRUE(names.contains("parts/part.pbrt") && names.contains("outside.pbrt")) << testing::PrintToString(names);
  succeed(
      {"render", "two/deep/s.pbrt", "-i", "path", "-p", "2", "-r", "8x8", "-q", "--resume", "a.state", "-o", "e.exr"});
}

// --help promises this for these methods, with their defaults and equal numbers of photons.
TEST_F(CliOptions, CropWindowsHoldThePixelsOfTheWholePicture) {
  for (const std::string name :
       {"path", "light", "bdpt", "vcm", "bpm", "probppm", "sppm", "ppm", "photonmap", "reversephotonmap"})
    expect_pixels_of_whole(render({"-i", name}));
}

// Aimed photons are aimed at what the whole picture shows.
TEST_F(CliOptions, CropWindowsHoldThePixelsOfTheWholePictureInLargeWorlds) {
  std::string large = tiny_scene;
  large +=
      R"(Shape "bilinearmesh" "point3 P" [-300 -1 -300 300 -1 -300 -300 -1 300 300 -1 300]
LightSource "distant" "point3 from" [1 3 2]
)";
  dir_.write("large.pbrt", large);
  for (const std::string name : {"vcm", "bpm", "probppm", "sppm", "ppm", "photonmap", "reversephotonmap"})
    expect_pixels_of_whole({"render", "large.pbrt", "-q", "-i", name, "-n", "5000"},
                           name == "sppm" || name == "ppm" ? 1e-6f : 0);
  EXPECT_TRUE(
      contains(succeed({"render", "large.pbrt", "-i", "probppm", "-p", "1", "-o", "a.exr"}).err, "lands in view"));
}

TEST_F(CliOptions, InfoTellsWhatStatesAndPicturesHold) {
  succeed(quick({"--seed", "5", "--set", "roulette-depth=7", "-o", "a.exr", "-o", "a.png", "-o", "a.state"}) +
          Words{"--crop", "1,2,5,8"});
  for (const std::string file : {"a.state", "a.exr", "a.png"}) {
    SCOPED_TRACE(file);
    const std::string table = succeed({"info", file}).out;
    for (const char* part : {"path", "tiny.pbrt", "seed       5", "roulette-depth=7", "4 x 6 pixels", "passes     1"})
      EXPECT_TRUE(contains(table, part)) << part << " is not in\n" << table;
    EXPECT_EQ(contains(table, "1,2,5,8 of 8 x 8"), file != "a.png") << table;
    const nlohmann::json report = nlohmann::json::parse(succeed({"info", file, "--json"}).out, nullptr, false);
    ASSERT_TRUE(report.is_object());
    EXPECT_EQ(report["settings"]["integrator"], "path");
    EXPECT_EQ(report["settings"]["seed"], 5);
    EXPECT_EQ(report["settings"]["parameters"]["roulette-depth"], "7");
    EXPECT_EQ(report["width"], 4);
    EXPECT_EQ(report["height"], 6);
    EXPECT_EQ(report["layers"][0], "color");
  }
  EXPECT_TRUE(contains(succeed({"info", "a.state"}).out, "intact"));
  std::string damaged = bytes("a.state");
  damaged[damaged.size() / 2] ^= 1;
  dir_.write("damaged.state", damaged);
  refuse({"info", "damaged.state"}, "damaged.state: damaged or truncated: its checksum does not match");
  dir_.write("damaged.exr", bytes("a.exr").substr(0, 200));
  refuse({"info", "damaged.exr"}, "damaged.exr");
  write_png(path("other.png"), Image(3, 2, {"R", "G", "B"}));
  const std::string other = succeed({"info", "other.png"}).out;
  EXPECT_TRUE(contains(other, "3 x 2 pixels") && contains(other, "no settings of Lanthorn")) << other;
}

TEST_F(CliOptions, IndicesOfRefractionAreMoreThanZero) {
  const std::vector<std::pair<std::string, std::string>> materials{
      {R"("dielectric" "float eta" [0])", "eta"},
      {R"("dielectric" "float eta" [-1.5])", "eta"},
      {R"("dielectric" "spectrum eta" [400 1.5 600 0])", "eta"},
      {R"("thindielectric" "float eta" [0])", "eta"},
      {R"("coateddiffuse" "float eta" [-1])", "eta"},
      {R"("coatedconductor" "float interface.eta" [0])", "interface.eta"},
      {R"("subsurface" "float eta" [0])", "eta"},
      {R"("hair" "float eta" [0])", "eta"},
      {R"("conductor" "spectrum eta" [400 -1 600 1])", "eta"},
      {R"("conductor" "spectrum k" [400 -1 600 1])", "k"},
      {R"("dielectric" "float eta" [nan])", "nan"}};
  for (const auto& [material, says] : materials) {
    std::string text = tiny_scene;
    text.insert(text.find("AttributeBegin"), "Material " + material + "\n");
    dir_.write("bad.pbrt", text);
    const std::string message = refuse({"info", "bad.pbrt"}, says);
    EXPECT_TRUE(message.starts_with("lanthorn: bad.pbrt:5:")) << material << '\n' << message;
  }
  dir_.write("m.mtl", "newmtl glass\nillum 7\nNi 0\n");
  dir_.write("m.obj", "mtllib m.mtl\nusemtl glass\nv -1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string said = succeed({"info", "m.obj"}).out;
  EXPECT_TRUE(contains(said, "m.mtl:3:4: the index of refraction Ni is 0: 1.5 is used")) << said;
}

}  // namespace
}  // namespace lanthorn::options_test
