// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The program as users experience it: exit codes, messages, and files written or not written.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "cli_fixture.h"
#include "lanthorn/file.h"
#include "lanthorn/image.h"
#include "lanthorn/image_file.h"
#include "render/state.h"
#include "support/gltf_writer.h"

namespace lanthorn::cli_test {
namespace {

const Words integrators{"auto",      "probppm",          "sppm",    "ppm", "vcm", "bpm", "bdpt", "path", "light", "mlt",
                        "photonmap", "reversephotonmap", "splitsum"};
const Words subcommands{"render",  "info",    "compare", "converge", "photons", "ibl",
                        "convert", "denoise", "develop", "merge",    "shards",  "list"};

TEST_F(Cli, HelpNamesSubcommandsAndOptions) {
  const Ending program = succeed({"--help"});
  for (const std::string& name : subcommands) EXPECT_TRUE(contains(program.out, name)) << name;
  const std::map<std::string, Words> options{
      {"render",
       {"--output", "--integrator", "--passes",   "--time",           "--pass-range", "--threads",     "--seed",
        "--color",  "--resolution", "--crop",     "--photons",        "--max-depth",  "--set",         "--checkpoint",
        "--resume", "--json",       "--exposure", "--view-transform", "--quiet",      "--reproducible"}},
      {"info", {"--json"}},
      {"compare", {"--layer", "--sem", "--runs", "--diff", "--json", "--max-mse", "--require-agreement", "Exit code"}},
      {"photons", {"--output", "--photons", "--pass", "--direct"}},
      {"converge", {"--integrator", "--passes", "--runs", "--reference", "--fit-from", "--plot", "--json"}},
      {"ibl", {"ENV", "--output", "--maps", "--formats", "--texels", "--mapping", "--size", "--samples", "--check"}},
      {"convert", {"scene", "output", "--sandbox", "pbrt-v3"}},
      {"denoise", {"input", "--output", "--replace", "--exposure", "--reproducible"}},
      {"develop", {"picture", "output", "--layer", "--exposure", "--view-transform"}},
      {"merge", {"--output", "--expect", "--exposure", "--view-transform", "--reproducible"}},
      {"shards", {"--passes", "--shards", "--format", "--output", "--look-at"}},
      {"list", {"integrator"}}};
  for (const std::string& name : subcommands) {
    const Ending help = succeed({name, "--help", "--all"});
    EXPECT_EQ(help.err, "") << name;
    for (const std::string& option : options.at(name)) EXPECT_TRUE(contains(help.out, option)) << name << option;
  }
}

TEST_F(Cli, ConvertTranslatesToPbrtV4) {
  dir_.write("old/part.pbrt", R"(Shape "sphere"
)");
  dir_.write("old/scene.pbrt",
             R"(Film "image" "integer xresolution" 8 "integer yresolution" 8
WorldBegin
LightSource "infinite"
Translate 0 0 4
Material "matte" "float sigma" 9
Include "part.pbrt"
WorldEnd
)");
  const Ending ending = succeed({"convert", "old/scene.pbrt", "new.pbrt"});
  EXPECT_EQ(ending.out, "new.pbrt: old/scene.pbrt as a pbrt-v4 file\n");
  EXPECT_TRUE(contains(ending.err, R"(old/scene.pbrt:5:1: the roughness "sigma")")) << ending.err;
  EXPECT_TRUE(contains(succeed({"info", "new.pbrt"}).out, "2 diffuse"));
  refuse({"convert", "new.pbrt", "newer.pbrt"}, R"(Film "rgb" in line 1 belongs to pbrt-v4)");
  refuse({"convert", "old/scene.pbrt", "old/part.pbrt"}, "part.pbrt, which the scene reads");
  refuse({"convert", "old/scene.pbrt", "old/scene.pbrt"}, "is the scene file");
  refuse({"convert", "old/scene.pbrt", "new.txt"}, "expected a name that ends in .pbrt");
}

TEST_F(Cli, RenderSaysWhatTheDepthLimitCutsOff) {
  const std::string milk =
      R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
WorldBegin
LightSource "infinite"
MakeNamedMedium "milk" "string type" "homogeneous" "rgb sigma_s" [9 9 9] "rgb sigma_a" [0 0 0]
MediumInterface "milk" ""
Material "interface"
Translate 0 0 3
Shape "sphere"
)";
  dir_.write("file.pbrt", R"(Integrator "path" "integer maxdepth" 4
)" + milk);
  dir_.write("milk.pbrt", milk);
  const auto render_milk = [&](const std::string& scene, const Words& options) {
    return succeed(Words{"render", scene, "-i", "path", "-p", "2", "-q", "--color", "rgb"} + options);
  };
  const Ending cut = render_milk("file.pbrt", {"-o", "a.state", "-o", "a.exr", "--json", "a.json"});
  EXPECT_TRUE(contains(cut.err, "the limit of 4 scattering events ended paths that still had ")) << cut.err;
  const nlohmann::json limit = nlohmann::json::parse(read_file(dir_.path() / "a.json"))["depth_limit"];
  EXPECT_EQ(limit["max_depth"], 4);
  EXPECT_GT(limit["eye"]["cut_share"].get<double>(), 0.01);
  EXPECT_EQ(limit["eye"]["paths"], 128);
  for (const char* file : {"a.state", "a.exr"}) {
    EXPECT_TRUE(contains(succeed({"info", file}).out, "depth      ended paths that still had ")) << file;
    EXPECT_TRUE(contains(succeed({"info", file, "--json"}).out, R"("cut_share")")) << file;
  }
  // No warning if the user chose the limit.
  EXPECT_EQ(render_milk("file.pbrt", {"-o", "b.state", "-d", "3"}).err, "");
  const Ending chosen =
      succeed({"render", "file.pbrt", "-i", "path", "-p", "2", "--color", "rgb", "-o", "b.exr", "-d", "3"});
  EXPECT_TRUE(contains(chosen.out, "the limit of 3 scattering events ended paths that still had ")) << chosen.out;
  EXPECT_FALSE(contains(chosen.err, "warning")) << chosen.err;
  // The default limit is high enough for the media's scattering.
  EXPECT_EQ(render_milk("milk.pbrt", {"-o", "c.state"}).err, "");
  EXPECT_TRUE(contains(succeed({"info", "c.state"}).out, "max-depth  4096"));
}

TEST_F(Cli, DevelopMakesThePngThatRenderWrites) {
  succeed(render({"-p", "2", "-o", "a.exr", "-o", "a.png", "--exposure", "1.5", "--view-transform", "filmic"}));
  const Ending ending = succeed({"develop", "a.exr", "b.png", "--exposure", "1.5", "--view-transform", "filmic"});
  EXPECT_EQ(ending.out, "b.png: layer color of a.exr\n");
  expect_equal_files("b.png", "a.png");
  EXPECT_TRUE(contains(succeed({"develop", "a.exr", "c.png", "--exposure", "auto"}).out, "measured from the picture"));
  succeed({"develop", "a.exr", "direct.png", "--layer", "direct", "--exposure", "1.5", "--view-transform", "filmic"});
  EXPECT_FALSE(bytes("direct.png") == bytes("a.png"));
  succeed({"develop", "a.exr", "depth.png", "--layer", "depth"});
  refuse({"develop", "a.exr", "x.png", "--layer", "sparkle"}, "a.exr: has no layer sparkle; it has color, ");
  refuse({"develop", "a.exr", "x.gif"}, "expected a name that ends in .png");
  refuse({"develop", "a.png", "a.png"}, "is the picture");
  refuse({"develop", "tiny.pbrt", "x.png"}, "tiny.pbrt");
  refuse({"convert", "a.exr", "x.png"}, "develop makes a .png of it");
}

// --denoise renders a margin around the crop, which only states hold; a resumed state keeps its margin or its lack of
// one.
TEST_F(Cli, DenoiseRendersAMarginAroundACrop) {
  const Words crop{"--crop", "4,5,12,9", "--reproducible"};
  succeed(render(crop + Words{"-p", "4", "-o", "plain.exr", "-o", "plain.state"}));
  succeed(render(crop + Words{"-p", "4", "--denoise", "-o", "a.exr", "-o", "a.state"}));
  const Image plain = read_image(path("plain.exr")), both = read_image(path("a.exr"));
  EXPECT_EQ(both.width, plain.width);
  EXPECT_EQ(both.window, plain.window);
  for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
    const std::size_t pixel = i / plain.channel_count();
    const std::string& channel = plain.channels[i % plain.channel_count()];
    const auto found = both.find_channel(channel);
    ASSERT_TRUE(found) << channel;
    ASSERT_EQ(plain.pixels[i], both.pixels[pixel * both.channel_count() + *found]) << channel;
  }
  succeed({"denoise", "a.state", "-o", "b.exr", "--reproducible"});
  expect_equal_files("b.exr", "a.exr");
  EXPECT_TRUE(contains(succeed({"info", "a.state"}).out, "8 x 4 pixels, the part 4,5,12,9 of 16 x 16"));
  succeed(render(crop + Words{"-p", "6", "-o", "more.exr", "--resume", "a.state"}));
  succeed(render(crop + Words{"-p", "6", "--denoise", "-o", "more.exr", "--resume", "plain.state"}));
  refuse({"merge", "a.state", "plain.state", "-o", "x.exr"}, "the margin that --denoise adds to --crop");
}

TEST_F(Cli, DenoiseAfterwardsIsTheSameAsWhileRendering) {
  succeed(render({"-p", "6", "--denoise", "-o", "a.exr", "-o", "a.png", "-o", "a.state", "--reproducible"}));
  succeed(render({"-p", "6", "-o", "plain.exr", "--reproducible", "--threads", "3"}));
  succeed({"denoise", "a.state", "-o", "b.exr", "--reproducible"});
  expect_equal_files("b.exr", "a.exr");
  const Ending ending = succeed({"denoise", "plain.exr", "-o", "c.png"});
  EXPECT_TRUE(contains(ending.out, "c.png: plain.exr without noise, error "));
  const Image now = read_image(path("a.png")), later = read_image(path("c.png"));  // stores noise with 16 bits
  for (std::size_t i = 0; i < now.pixels.size(); ++i) EXPECT_NEAR(later.pixels[i], now.pixels[i], 0.02f) << i;
  succeed({"denoise", "plain.exr", "-o", "d.exr", "--replace"});
  const Image clean = read_image(path("d.exr")), both = read_image(path("a.exr"));
  EXPECT_FALSE(clean.find_channel("noise.share") || clean.find_channel("denoised.R"));
  EXPECT_NEAR(clean.at(3, 3, *clean.find_channel("G")), both.at(3, 3, *both.find_channel("denoised.G")), 0.01f);
  EXPECT_TRUE(contains(succeed({"info", "a.exr"}).out, "\ndenoised   "));
  refuse({"denoise", "d.exr", "-o", "x.exr"}, "d.exr: the picture has no layers `noise`");
  refuse({"denoise", "a.png", "-o", "x.exr"}, "a.png: the picture has no layers `noise`");
  refuse({"denoise", "a.exr", "-o", "x.gif"}, "expected a name that ends in .exr");
  refuse({"denoise", "a.exr", "-o", "a.exr"}, "is the picture");
  refuse({"denoise", "none.exr", "-o", "x.exr"}, "none.exr");
  const Ending single = run(render({"-p", "1", "--denoise", "-o", "x.exr"}));
  EXPECT_EQ(single.exit_code, 0);
  EXPECT_TRUE(contains(single.err, "a picture of a single pass is not denoised"));
  refuse({"denoise", "x.exr", "-o", "y.exr"}, "x.exr: a picture of a single pass cannot be denoised");
}

TEST_F(Cli, VersionIsANumber) {
  const Ending ending = succeed({"--version"});
  EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(ending.out.front()))) << ending.out;
  EXPECT_EQ(std::count(ending.out.begin(), ending.out.end(), '\n'), 1) << ending.out;
  // The README contains the text for citations.
  std::ifstream in(LANTHORN_SOURCE_DIR "/README.md");
  const std::string readme{std::istreambuf_iterator<char>(in), {}};
  EXPECT_TRUE(contains(readme, "{Version " + ending.out.substr(0, ending.out.size() - 1) + "}"));
}

// Loading them takes 0.25 s of CPU time.
TEST_F(Cli, StartsWithoutTheLibrariesThatReadImages) {
  const Ending libraries = ChildProcess("/usr/bin/ldd", {LANTHORN_PROGRAM}, dir_.path()).wait();
  EXPECT_TRUE(contains(libraries.out, "libembree")) << libraries.out << libraries.err;
  EXPECT_FALSE(contains(libraries.out, "OpenImageIO"));
  EXPECT_LE(std::count(libraries.out.begin(), libraries.out.end(), '\n'), 40) << libraries.out;
}

TEST_F(Cli, LoadsThemForNoOtherFilesThanTheyRead) {
  const auto loads_them = [&](const std::string& command) {
    const Ending ending = run_shell("LD_DEBUG=files " + command);
    EXPECT_EQ(ending.exit_code, 0) << ending.err;
    EXPECT_TRUE(contains(ending.err, "libembree")) << "the loader says what it loads";
    return contains(ending.err, "libOpenImageIO");
  };
  dir_.write("sky.hdr", std::string("#?RADIANCE\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x80\x80\x80\x81", 34));
  EXPECT_FALSE(loads_them("L ibl sky.hdr -o out -q --size 8 --smallest 8 --samples 16"));
  EXPECT_FALSE(loads_them("L render tiny.pbrt -o a.exr -p 1 -q"));
  EXPECT_FALSE(loads_them("L render tiny.pbrt -o a.png -p 1 -q"));
  EXPECT_TRUE(loads_them("L info a.png"));
}

TEST_F(Cli, ListNamesIntegratorsFirstAndTheirParameters) {
  const Ending all = succeed({"list"});
  const std::ptrdiff_t by_opengl = contains(all.out, "\nispm ") ? 2 : 0;  // only if built in
  EXPECT_EQ(std::count(all.out.begin(), all.out.end(), '\n'),
            static_cast<std::ptrdiff_t>(integrators.size()) + by_opengl);
  for (const std::string& name : integrators) EXPECT_TRUE(contains("\n" + all.out, "\n" + name + " ")) << name;
  EXPECT_TRUE(contains(succeed({"list", "path"}).out, "roulette-depth"));
  const std::string parameters = succeed({"list", "probppm"}).out;
  for (const char* name : {"alpha", "kernel", "radius"}) EXPECT_TRUE(contains(parameters, name)) << name;
  const std::string message = refuse({"list", "nosuch"}, "nosuch");
  for (const std::string& name : integrators) EXPECT_TRUE(contains(message, name)) << name;
}

TEST_F(Cli, InfoCountsWhatIsInAScene) {
  const std::string table = succeed({"info", "tiny.pbrt"}).out;
  EXPECT_TRUE(contains(table, "6 triangles")) << table;
  EXPECT_TRUE(contains(table, "1 quadrics")) << table;
  EXPECT_TRUE(contains(table, "16 x 16")) << table;

  const std::string text = succeed({"info", "tiny.pbrt", "--json"}).out;
  const nlohmann::json info = nlohmann::json::parse(text, nullptr, false);
  ASSERT_TRUE(info.is_object()) << text;
  EXPECT_EQ(info["triangles"], 6);
  EXPECT_EQ(info["quadrics"], 1);
  EXPECT_EQ(info["patches"], 0);
  EXPECT_EQ(info["instances"], 0);
  EXPECT_EQ(info["lights"]["area"], 1);  // an area light of two triangles
  EXPECT_EQ(info["lights"]["spot"], 1);
  EXPECT_GE(info["materials"]["dielectric"], 1);
  EXPECT_FLOAT_EQ(info["bounds"]["max"][1].get<float>(), 2);
  EXPECT_GT(info["memory_bytes"]["geometry"], 0);
  EXPECT_EQ(info["method"], "auto");
}

TEST_F(Cli, InfoNamesTheMethodOfAStateAndOfAPicture) {
  succeed({"render", "tiny.pbrt", "-i", "bdpt", "-p", "1", "-q", "-o", "a.state", "-o", "a.exr", "-o", "a.png"});
  for (const char* file : {"a.state", "a.exr", "a.png"}) {
    EXPECT_TRUE(contains(succeed({"info", file}).out, "\nmethod     bdpt\n")) << file;
    EXPECT_EQ(nlohmann::json::parse(succeed({"info", file, "--json"}).out)["method"], "bdpt") << file;
  }
  write_exr(path("foreign.exr"), Image(2, 2, {"R", "G", "B"}));
  EXPECT_TRUE(contains(succeed({"info", "foreign.exr"}).out, "\nmethod     (not known"));
  EXPECT_TRUE(nlohmann::json::parse(succeed({"info", "foreign.exr", "--json"}).out)["method"].is_null());
}

void expect_plausible_statistics(const nlohmann::json& s, const std::string& integrator) {
  ASSERT_TRUE(s.is_object());
  EXPECT_EQ(s.value("passes", 0), 3);
  EXPECT_EQ(s.value("passes_total", 0), 3);
  EXPECT_GT(s.value("seconds", 0.0), 0);
  EXPECT_GE(s.value("seconds", 0.0), s.value("first_pass_seconds", 1e9));
  EXPECT_GT(s.value("cpu_seconds_process", 0.0), 0);
  EXPECT_GT(s.value("peak_memory_bytes", 0.0), 1 << 20);
  EXPECT_GE(s.value("threads", 0), 1);
  EXPECT_GT(s["rays"]["nearest"], 0);
  const bool merges = integrator != "path" && integrator != "light" && integrator != "bdpt" && integrator != "mlt" &&
                      integrator != "splitsum";
  EXPECT_EQ(s["rays"]["shadow"] > 0, integrator != "bpm" && integrator != "splitsum");
  double phases = 0;
  for (const auto& seconds : s["phase_seconds"]) phases += seconds.get<double>();
  EXPECT_GT(phases, 0);
  EXPECT_LE(phases, s["seconds"].get<double>() * 1.001);
  EXPECT_EQ(s["film"]["non_finite"], 0);
  EXPECT_EQ(s["scene"]["triangles"], 6);
  EXPECT_EQ(s["settings"]["identity"]["integrator"], integrator);
  const int light_paths = s["photons_emitted"];
  if (integrator == "auto")  // a quarter of 900, or the other choices
    EXPECT_TRUE(light_paths == 225 || light_paths == 450 || light_paths == 900 || light_paths == 1800 ||
                light_paths == 3600)
        << light_paths;
  else
    EXPECT_EQ(light_paths, integrator == "path" || integrator == "mlt" || integrator == "splitsum" ? 0 : 900);
  EXPECT_EQ(s["photons_stored"] > 0, merges);
  EXPECT_EQ(s["photon_map_bytes"] > 0, merges);
  EXPECT_EQ(s["radius"] > 0, merges);
  EXPECT_EQ(s["volume_radius"], 0);  // no media
}

void expect_layers_add_up(const Image& image, const Words& parts) {
  const auto color = select_layer(image, "color");
  ASSERT_TRUE(color);
  std::vector<double> sum(color->pixels.size());
  for (const std::string& name : parts) {
    const auto layer = select_layer(image, name);
    ASSERT_TRUE(layer) << name;
    ASSERT_EQ(layer->pixels.size(), sum.size()) << name;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(layer->pixels[i]);
  }
  for (const char* name : {"albedo", "normal", "depth", "samples"}) EXPECT_TRUE(select_layer(image, name)) << name;
  double light = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const auto value = static_cast<double>(color->pixels[i]);
    light += value;
    ASSERT_NEAR(value, sum[i], 1e-6 + 1e-5 * std::fabs(value)) << "value " << i;
  }
  EXPECT_GT(light, 0);
}

TEST_F(Cli, RendersByEveryIntegratorToEveryKindOfFile) {
  for (const std::string& name : integrators) {
    SCOPED_TRACE(name);
    succeed(
        render({"-i", name, "-p", "3", "-o", "a.exr", "-o", "a.png", "-o", "a.state", "--json", "a.json", "--force"}));
    const Image exr = read_image(path("a.exr")), png = read_image(path("a.png"));
    EXPECT_EQ(exr.width, 16);
    EXPECT_EQ(exr.height, 16);
    EXPECT_EQ(png.width, 16);
    expect_layers_add_up(exr, {"direct", "indirect", "caustic", "emission"});
    if (name == "vcm" || name == "bdpt" || name == "bpm")
      expect_layers_add_up(exr, {"technique.hit", "technique.nee", "technique.vc", "technique.vm", "technique.splat"});
    if (name == "photonmap" || name == "reversephotonmap")
      expect_layers_add_up(exr, {"emission", "term.A", "term.B", "term.C", "term.D"});
    EXPECT_EQ(load_state(path("a.state")).pass_count(), 3u);
    EXPECT_EQ(metadata_of("a.exr")["passes"], 3);
    expect_plausible_statistics(json("a.json"), name);
    EXPECT_EQ(files(), (Words{"a.exr", "a.json", "a.png", "a.state", "tiny.pbrt"}));
  }
}

// The media radius of the last pass; it shrinks according to the estimator's dimension.
TEST_F(Cli, ReportsTheRadiusInMedia) {
  dir_.write("fog.pbrt",
             R"(LookAt 0 0 -3  0 0 0  0 1 0
MediumInterface "" "fog"
Camera "perspective"
Film "rgb" "integer xresolution" [8] "integer yresolution" [8]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0 0 0] "rgb sigma_s" [.3 .3 .3]
WorldBegin
MediumInterface "fog" "fog"
LightSource "point" "point3 from" [0 1 0]
Shape "sphere" "float radius" [4]
)");
  const auto radius = [&](const std::string& integrator, const Words& more) {
    succeed(Words{"render", "fog.pbrt", "-q", "-n", "500", "-i", integrator, "-o", "a.exr", "--json", "a.json"} + more);
    return json("a.json")["volume_radius"].get<double>();
  };
  const auto of_third_pass = [&](const std::string& integrator, const std::string& volume) {
    return radius(integrator, {"-p", "3", "--set", "volume-radius=0.25", "--set", "alpha=0.5", "--set", volume});
  };
  // Areas shrink by (i + α) / (i + 1) from pass to pass; merges have an α of their own, 2/3.
  const double shrunk = 1.5 / 2 * 2.5 / 3, merges_shrunk = (5.0 / 3) / 2 * (8.0 / 3) / 3;
  EXPECT_NEAR(of_third_pass("probppm", "volume=beam"), 0.25 * std::sqrt(shrunk), 1e-6);
  EXPECT_NEAR(of_third_pass("sppm", "volume=beams"), 0.25 * shrunk, 1e-6);
  EXPECT_NEAR(of_third_pass("vcm", "volume=point+beam+photon-beam+beams"), 0.25 * std::cbrt(merges_shrunk),
              1e-6);  // the point estimator
  EXPECT_EQ(of_third_pass("vcm", "volume=path"), 0);
  for (const char* keeps_it : {"photonmap", "reversephotonmap"})
    EXPECT_NEAR(radius(keeps_it, {"-p", "3", "--set", "volume-radius=0.25"}), 0.25, 1e-6) << keeps_it;
  const double found = radius("probppm", {"-p", "1"});  // chosen by a pilot: at most a tenth of the scene's size
  EXPECT_GT(found, 0);
  EXPECT_LT(found, 0.7);
}

TEST_F(Cli, MemoryIsASize) {
  const Words reverse = render({"-i", "reversephotonmap", "-p", "1"});
  succeed(reverse + Words{"--memory", "1M", "-o", "small.exr"});
  succeed(reverse + Words{"--memory", "2G", "-o", "large.exr"});
  EXPECT_EQ(read_image(path("small.exr")).pixels, read_image(path("large.exr")).pixels);
  refuse(reverse + Words{"--memory", "much", "-o", "a.exr"}, "--memory");
  refuse(reverse + Words{"--memory", "1X", "-o", "a.exr"}, "--memory");
}

TEST_F(Cli, WritesPhotons) {
  const Words photons{"photons", "tiny.pbrt", "-n", "5000", "-d", "4"};
  const std::string said = succeed(photons + Words{"-T", "1", "--direct", "-o", "a.ply"}).out;
  EXPECT_TRUE(contains(said, "5000 light paths")) << said;
  succeed(photons + Words{"-T", "2", "--direct", "-o", "b.ply"});
  succeed(photons + Words{"-o", "indirect.ply"});
  const std::string ply = read_file(path("a.ply"));
  EXPECT_EQ(ply, read_file(path("b.ply")));
  const auto count_of = [](const std::string& file) { return std::stoul(file.substr(file.find("vertex ") + 7)); };
  const std::string end = "end_header\n";
  EXPECT_EQ(ply.size() - ply.find(end) - end.size(), count_of(ply) * (12 * sizeof(float) + 4));
  EXPECT_GT(count_of(ply), count_of(read_file(path("indirect.ply"))));
  refuse(photons + Words{"-o", "nowhere/a.ply"}, "nowhere");
  refuse(photons, "--output");
}

// If few photons land in view, methods aim them; the default method does so, too.
TEST_F(Cli, PhotonsOfTheDefaultMethodAreThoseOfVcm) {
  dir_.write("large.pbrt", tiny_scene + std::string(R"(LightSource "distant" "point3 from" [1 3 2]
Shape "bilinearmesh" "point3 P" [-300 -1 -300 300 -1 -300 -300 -1 300 300 -1 300]
)"));
  const Words photons{"photons", "large.pbrt", "-n", "5000", "-o"};
  succeed(photons + Words{"default.ply"});
  succeed(photons + Words{"vcm.ply", "-i", "vcm"});
  succeed(photons + Words{"plain.ply", "-i", "vcm", "--set", "emission=power"});
  EXPECT_TRUE(bytes("default.ply") == bytes("vcm.ply"));
  EXPECT_FALSE(bytes("default.ply") == bytes("plain.ply"));
}

TEST_F(Cli, MeasuresConvergence) {
  succeed({"render", "tiny.pbrt", "-q", "-i", "path", "-p", "64", "-r", "8x8", "-o", "reference.exr"});
  const Words converge{"converge", "tiny.pbrt", "-i", "path", "-p", "16", "--runs", "8", "-r"};
  const std::string table = succeed(converge + Words{"8x8", "--reference", "reference.exr", "--fit-from", "1", "--json",
                                                     "c.json", "--plot", "c.svg"})
                                .out;
  EXPECT_TRUE(contains(table, "variance ~ passes^-"));
  const nlohmann::json report = json("c.json");
  ASSERT_EQ(report["points"].size(), 5u);
  EXPECT_EQ(report["points"][4]["passes"], 16);
  EXPECT_LT(report["variance_slope"].get<double>(), -0.8);  // -1 for independent samples, smaller for stratified ones
  EXPECT_GT(report["points"][0]["rms_error"], report["points"][4]["rms_error"]);
  EXPECT_GT(fs::file_size(path("c.svg")), 500u);
  EXPECT_TRUE(contains(succeed(converge + Words{"8x8"}).out, "no exponents: "));  // 16 passes, and --fit-from 16
  refuse(converge + Words{"9x8", "--reference", "reference.exr"}, "8 x 8");
  refuse({"converge", "tiny.pbrt", "--runs", "1"}, "--runs");
}

TEST_F(Cli, RendersModelsWithoutCameraOrLight) {
  test::GltfWriter model;
  const test::SphereMesh ball = test::sphere_mesh(1, 6, 8);
  model.mesh(ball.positions, ball.indices);
  model.node({{"mesh", 0}});
  const fs::path folder = dir_.path();
  dir_.write("ball.glb", model.binary());
  dir_.write("ball.obj", "v -1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const char* const name : {"ball.glb", "ball.obj"}) {
    const Ending ending = succeed({"render", name, "-o", "ball.png", "-p", "1", "-r", "16x16", "-i", "path"});
    EXPECT_TRUE(contains(ending.err, std::string(name) + ": the file has no camera and no light: a view of all of it"));
    EXPECT_TRUE(contains(ending.err, "in a studio of three soft lamps, stands in"));
    const Image picture = read_image(folder / "ball.png");
    EXPECT_NE(picture.pixels[0], picture.pixels[3 * (8 * 16 + 8)]);  // the background differs from the model
    EXPECT_TRUE(contains(succeed({"info", name}).out, "1280 x 720 pixels"));
  }
  dir_.write("broken.gltf", R"({"asset": {"version": "2.0"}, "scene": 4})");
  dir_.write("model.stl", "solid");
  refuse({"render", "broken.gltf", "-o", "a.png"}, "broken.gltf#/scene: is 4, but there are 0 scenes");
  dir_.write("ring.blend", "BLENDER");
  refuse({"render", "model.stl", "-o", "a.png"}, "unknown kind of scene file");
  refuse({"model.stl"}, "such as Blender, export .glb");  // a file alone is no subcommand
  refuse({"ring.blend"}, "the add-on renders Blender's files");
  refuse({"none.glb"}, "none.glb: expected an existing file");
  refuse({}, "a scene or a subcommand is missing, such as 'lanthorn scene.pbrt'");
}

TEST_F(Cli, WritesToTheSceneFilesOwnNameAndReportsProgress) {
  const Ending ending = succeed({"render", "tiny.pbrt", "-p", "2", "--photons", "300"});
  EXPECT_EQ(files(), (Words{"tiny.exr", "tiny.pbrt"}));
  EXPECT_TRUE(contains(ending.out, "tiny.exr")) << ending.out;
  EXPECT_TRUE(contains(ending.err, "pass 2/2")) << ending.err;
  EXPECT_FALSE(contains(ending.err, "\r")) << "a pipe is no terminal";
  EXPECT_EQ(succeed(render({"-p", "1", "-o", "q.png"})).err, "");
}

TEST_F(Cli, CropIsAPartOfTheWholePicture) {
  succeed(render({"-i", "path", "-p", "1", "-o", "a.exr", "--crop", "4,5,12,9"}));
  const Image image = read_image(path("a.exr"));
  EXPECT_EQ(image.width, 8);
  EXPECT_EQ(image.height, 4);
  EXPECT_EQ(image.window, (ImageWindow{4, 5, 16, 16}));
}

TEST_F(Cli, SceneErrorsNameFileLineAndColumn) {
  struct Case {
    const char *line, *place, *says;
  };
  // The directive is inserted at line 5.
  const Case cases[]{{R"(  Shap "sphere")", "bad.pbrt:5:3: ", "Shap"},
                     {R"(Shape "sphere" "float radius" [1)", "bad.pbrt:", ""},
                     {R"(Shape "sphere" "float radius" ["x"])", "bad.pbrt:5:", "expected a number"},
                     {"AttributeEnd", "bad.pbrt:5:1: ", "AttributeEnd"},
                     {R"(Material "diffuse" "texture reflectance" "nosuch")", "bad.pbrt:5:", "nosuch"},
                     {R"(Shape "plymesh" "string filename" "nosuch.ply")", "bad.pbrt:5:", "nosuch.ply"},
                     {R"(Include "nosuch.pbrt")", "bad.pbrt:5:", "nosuch.pbrt"},
                     {R"(Shape "sphere" "flaot radius" [1])", "bad.pbrt:5:", "flaot"}};
  for (const Case& c : cases) {
    std::string text = tiny_scene;
    text.insert(text.find("AttributeBegin"), std::string(c.line) + "\n");
    dir_.write("bad.pbrt", text);
    const std::string message = refuse({"render", "bad.pbrt", "-p", "1", "-q", "-o", "out.exr"}, c.says);
    EXPECT_TRUE(message.starts_with(std::string("lanthorn: ") + c.place)) << c.line << '\n' << message;
  }
  dir_.write("part.pbrt", "\n\n Nonsense");
  dir_.write("bad.pbrt", std::string(tiny_scene) + R"(Include "part.pbrt"
)");
  EXPECT_TRUE(contains(refuse({"info", "bad.pbrt"}, "Nonsense"), "part.pbrt:3:2: ")) << "the place is in the part";
}

TEST_F(Cli, WrongOptionsAreRefusedBeforeTheRender) {
  fs::create_directory(path("folder"));
  const Words quick{"-p", "1", "-o", "out.exr"};
  const auto refuse_render = [&](const Words& more, const std::string& says) { refuse(render(quick + more), says); };
  const std::string message = refuse(render(quick + Words{"-i", "nosuch"}), "nosuch");
  for (const std::string& name : integrators) EXPECT_TRUE(contains(message, name)) << name;

  refuse_render({"-i", "path", "--set", "nosuch=1"}, "list path");
  refuse_render({"-i", "path", "--set", "roulette-depth=0"}, "roulette-depth=0");
  refuse_render({"-i", "path", "--set", "roulette-depth=x"}, "roulette-depth=x");
  refuse_render({"-i", "path", "--set", "roulette-depth"}, "name=value");
  for (const char* bad : {"alpha=0", "alpha=1.5", "alpha=nan", "kernel=cubic", "radius=-1", "radius=0", "radius=inf"})
    refuse_render({"-i", "probppm", "--set", bad}, bad);
  for (const char* bad : {"strategy=1", "strategy=2,0", "strategy=0,1", "strategy=1,2,3"})
    refuse_render({"-i", "bdpt", "--set", bad}, bad);
  refuse_render({"-i", "mlt", "--set", "over=light"}, "over=light");
  for (const char* bad : {"alpha=0", "schedule=none", "hits=0", "kernel=cubic"})
    refuse_render({"-i", "ppm", "--set", bad}, bad);
  refuse({"render", "tiny.pbrt", "-i", "sppm", "--pass-range", "1:2", "-o", "out.exr"}, "depends on all before it");
  for (const char* bad : {"16x", "x16", "16x16x", "0x16", "99999x1"})
    refuse_render({"--resolution", bad}, "--resolution");
  for (const char* bad : {"0,0,8", "0,0,8,8,", "0,0,99,99", "8,8,8,9", "-1,0,8,8"})
    refuse_render({"--crop=" + std::string(bad)}, "--crop");
  for (const char* bad : {"2:2", "1", "0:1:2", "-1:2", "4294967295:4294967297"})
    refuse(render({"-o", "out.exr", "--pass-range=" + std::string(bad)}), "--pass-range");
  refuse_render({"--pass-range", "0:1"}, "--pass-range");
  refuse_render({"--resume", "nosuch.state"}, "nosuch.state");
  refuse_render({"--resume", "tiny.pbrt"}, "tiny.pbrt");
  refuse_render({"--json", "nosuch/a.json"}, "nosuch");
}

TEST_F(Cli, WrongFilesAreRefusedBeforeTheRender) {
  refuse(render({"-p", "1", "-o", "out.gif"}), "out.gif");
  refuse(render({"-p", "1", "-o", "out"}), "-o out");
  refuse(render({"-p", "1", "-o", "out.exr", "-o", "nosuch/out.png"}), "nosuch");
  refuse({"render", "nosuch.pbrt", "-o", "out.exr"}, "nosuch.pbrt");
  refuse({"render", ".", "-o", "out.exr"}, "scene .: expected an existing file");
  dir_.write("scene.blend", tiny_scene);
  refuse({"render", "scene.blend", "-o", "out.exr"}, "scene.blend");
  refuse({"info", "nosuch.pbrt"}, "nosuch.pbrt");
  refuse({"merge", "nosuch.state", "-o", "out.exr"}, "nosuch.state");
  refuse({"merge", "tiny.pbrt", "-o", "out.exr"}, "tiny.pbrt");
  refuse({}, "subcommand");
  refuse({"nosuch"}, "subcommand");
}

// tests/transport checks that all methods give equal states; this test checks the same through the program's options,
// for methods with and without photons, and for methods whose passes depend on each other.
const Words some_integrators{"auto", "path", "probppm", "sppm"};

TEST_F(Cli, ThreadCountChangesNoByte) {
  for (const std::string& name : some_integrators)
    for (const std::string threads : {"1", "3"}) {
      const std::string base = name + threads;
      succeed(render(
          {"-i", name, "-p", "2", "-T", threads, "-o", base + ".exr", "-o", base + ".png", "-o", base + ".state"}));
      for (const char* extension : {".exr", ".png", ".state"})
        expect_equal_files(name + "1" + extension, base + extension);
    }
}

TEST_F(Cli, ResumedIsAsRenderedAtOnce) {
  for (const std::string& name : some_integrators) {
    SCOPED_TRACE(name);
    succeed(render({"-i", name, "-p", "2", "-o", "two.state", "--force"}));
    succeed(render(
        {"-i", name, "-p", "4", "--resume", "two.state", "-o", "resumed.state", "-o", "resumed.exr", "--force"}));
    succeed(render({"-i", name, "-p", "4", "-o", "whole.state", "-o", "whole.exr", "--force"}));
    expect_equal_files("whole.state", "resumed.state");
    expect_equal_files("whole.exr", "resumed.exr");
  }
}

TEST_F(Cli, ResumingWithOtherSettingsIsRefusedNamingThem) {
  succeed(render({"-i", "path", "-p", "1", "-o", "a.state"}));
  const auto refuse_resume = [&](const Words& more, const std::string& says) {
    refuse(render(Words{"-p", "2", "--resume", "a.state", "-o", "out.exr"} + more), says);
  };
  refuse_resume({"-i", "path", "--seed", "7"}, "seed (0 and 7)");
  refuse_resume({"-i", "light"}, "integrator");
  refuse_resume({"-i", "path", "-r", "8x8"}, "--resolution");
  refuse_resume({"-i", "path", "--set", "roulette-depth=5"}, "roulette-depth");
  std::string damaged = bytes("a.state");
  damaged[damaged.size() / 2] ^= 1;
  dir_.write("a.state", damaged);
  refuse_resume({"-i", "path"}, "a.state");
}

// Uses the scene's file names, one of which is not valid UTF-8.
const char* const scene_of_files = R"(LookAt 0 1 4.4  0 1 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [8] "integer yresolution" [8]
WorldBegin
LightSource "point" "spectrum I" "lamp.spd" "point3 from" [0 1.8 0.9]
Texture "image" "spectrum" "imagemap" "string filename" "image.pfm"
Include "parts/floor.pbrt"
Material "diffuse" "texture reflectance" "image"
Shape "plymesh" "string filename" "parts/wall.ply"
)";
const char* const wall =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "-1 0 -1\n1 0 -1\n1 2 -1\n3 0 1 2\n";
const char* const floor_part =
    "Import \"parts/caf\xe9.pbrt\"\n"
    R"(Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-1 0 1 1 0 1 1 0 -1]
)";

TEST_F(Cli, AChangeOfAnyFileOfTheSceneIsRefused) {
  const std::map<std::string, std::string> content{{"lamp.spd", "400 1\n700 2\n"},
                                                   {"image.pfm", "Pf\n1 1\n-1.0\n" + std::string("\0\0\0\x3f", 4)},
                                                   {"parts/floor.pbrt", floor_part},
                                                   {"parts/wall.ply", wall},
                                                   {"parts/caf\xe9.pbrt", R"(Material "diffuse"
)"}};
  // Additions that change the file's hash.
  const std::map<std::string, std::string> more{{"lamp.spd", "710 3\n"},
                                                {"image.pfm", " "},
                                                {"parts/floor.pbrt", "# more\n"},
                                                {"parts/wall.ply", "\n"},
                                                {"parts/caf\xe9.pbrt", " "}};
  for (const auto& [name, bytes] : content) dir_.write(name, bytes);
  dir_.write("files.pbrt", scene_of_files);
  const Words render{"render", "files.pbrt", "-i", "path", "-q", "--reproducible"};
  succeed(render + Words{"--pass-range", "0:1", "-o", "a.state"});
  const Words resume = render + Words{"-p", "2", "--resume", "a.state", "-o"};
  succeed(resume + Words{"resumed.exr"});
  for (const auto& [name, bytes] : content) {
    SCOPED_TRACE(name);
    dir_.write(name, bytes + more.at(name));
    const std::string says = "the content of " + name.substr(0, name.find('\xe9'));
    refuse(resume + Words{"out.exr"}, says);
    succeed(render + Words{"--pass-range", "1:2", "-o", "b.state", "--force"});
    refuse({"merge", "a.state", "b.state", "-o", "out.exr"}, says);
    dir_.write(name, bytes);
  }
  dir_.write("files.pbrt", std::string(scene_of_files) + "# more\n");
  refuse(resume + Words{"out.exr"}, "the content of the scene file");
  dir_.write("files.pbrt", scene_of_files);
  succeed(Words{"render", path("files.pbrt").string(), "-i", "path", "-q", "--reproducible"} +
          Words{"-p", "2", "--resume", "a.state", "-o", "from-elsewhere.exr"});
}

TEST_F(Cli, MergedShardsAreTheWhole) {
  for (const std::string name : {"path", "probppm"}) {
    SCOPED_TRACE(name);
    succeed(render({"-i", name, "-p", "4", "-o", "whole.state", "-o", "whole.exr", "-o", "whole.png", "--force"}));
    succeed(render({"-i", name, "--pass-range", "0:1", "-o", "a.state", "--force"}));
    succeed(render({"-i", name, "--pass-range", "1:3", "-o", "b.state", "--force"}));
    succeed(render({"-i", name, "--pass-range", "3:4", "-o", "c.state", "--force"}));
    succeed({"merge", "c.state", "a.state", "b.state", "-o", "merged.state", "--force"});
    expect_equal_files("whole.state", "merged.state");
    for (const std::string file : {"merged.exr", "merged.png"})
      succeed({"merge", "a.state", "b.state", "c.state", "--reproducible", "-o", file});
    expect_equal_files("whole.exr", "merged.exr");
    expect_equal_files("whole.png", "merged.png");
  }
  refuse({"merge", "a.state", "whole.state", "-o", "out.exr"}, "some passes are in both");
  refuse({"merge", "a.state", "a.state", "-o", "out.state"}, "some passes are in both");
  refuse({"merge", "a.state", "b.state", "-o", "out.gif"}, "out.gif");
  refuse({"merge", "a.state", "b.state", "-o", "nosuch/out.exr"}, "nosuch");
  succeed(render({"-i", "probppm", "--pass-range", "5:6", "--seed", "7", "-o", "other.state"}));
  refuse({"merge", "a.state", "other.state", "-o", "out.exr"}, "seed");
}

TEST_F(Cli, MergedFilesHoldTimesUnlessTheyAreToBeReproducible) {
  const Words timed{"render", "tiny.pbrt", "-i", "path", "-q", "--pass-range"};
  succeed(timed + Words{"0:1", "-o", "a.state"});
  succeed(timed + Words{"1:2", "-o", "b.state"});
  for (const bool reproducible : {false, true}) {
    for (const std::string file : {"merged.exr", "merged.state"})
      succeed(Words{"merge", "a.state", "b.state", "-o", file} + (reproducible ? Words{"--reproducible"} : Words{}));
    EXPECT_EQ(metadata_of("merged.exr").contains("seconds"), !reproducible);
    EXPECT_EQ(load_state(path("merged.state")).seconds > 0, !reproducible);
  }
}

TEST_F(Cli, ProgressOfAResumedShardCountsItsOwnPasses) {
  succeed(render({"-i", "path", "--pass-range", "0:2", "-o", "a.state"}));
  const Ending ending = succeed({"render", "tiny.pbrt", "-i", "path", "--photons", "300", "--pass-range", "2:4",
                                 "--resume", "a.state", "-o", "b.state"});
  EXPECT_TRUE(contains(ending.err, "pass 2/2")) << ending.err;
  EXPECT_EQ(load_state(path("b.state")).pass_count(), 4u);
}

TEST_F(Cli, CheckpointIsAStateToResumeFrom) {
  succeed(render({"-i", "path", "-p", "4", "-o", "a.exr", "--checkpoint", "0.0000001"}));
  const RenderState state = load_state(path("a.state"));
  EXPECT_EQ(state.pass_count(), 4u);
  EXPECT_EQ(state.integrator, "path");
}

TEST_F(Cli, TimeLimitEndsTheRender) {
  succeed(render({"-i", "path", "--time", "0.05s", "-o", "a.state"}));
  EXPECT_GE(load_state(path("a.state")).pass_count(), 1u);
}

TEST_F(Cli, InterruptedRenderSavesWhatItHas) {
  for (const int signal : {SIGINT, SIGTERM}) {
    ChildProcess child(
        LANTHORN_PROGRAM,
        {"render", "tiny.pbrt", "-i", "path", "-r", "64x64", "--time", "10m", "-o", "a.exr", "-o", "a.state"},
        dir_.path());
    // The first pass is reported immediately: then the render is running.
    while (!contains(child.err_so_far(), "pass 1") && !child.has_ended())
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    child.send(signal);
    const Ending ending = child.wait();
    EXPECT_EQ(ending.exit_code, 0) << "signal " << ending.signal << '\n' << ending.err;
    EXPECT_EQ(files(), (Words{"a.exr", "a.state", "tiny.pbrt"}));
    const RenderState state = load_state(path("a.state"));
    EXPECT_GE(state.pass_count(), 1u);
    const Image image = read_image(path("a.exr"));
    EXPECT_EQ(image.width, 64);
    EXPECT_EQ(metadata_of("a.exr")["passes"], state.pass_count());
    const auto color = select_layer(image, "color");
    const auto saved = select_layer(state.film.resolve(state.pass_count()), "color");
    ASSERT_TRUE(color && saved);
    EXPECT_TRUE(color->pixels == saved->pixels);
    fs::remove(path("a.exr"));
    fs::remove(path("a.state"));
  }
}

TEST_F(Cli, CompareExitCodes) {
  succeed(render({"-i", "path", "-p", "1", "-o", "a.exr"}));
  succeed(render({"-i", "path", "-p", "1", "--seed", "1", "-o", "b.exr"}));
  succeed(render({"-i", "path", "-p", "1", "-r", "8x8", "-o", "small.exr"}));
  const Ending same = succeed({"compare", "a.exr", "a.exr", "--max-mse", "0", "--max-relmse", "0", "--max-flip", "0",
                               "--max-mean-difference", "0"});
  EXPECT_TRUE(contains(same.out, "MSE")) << same.out;
  succeed({"compare", "a.exr", "b.exr", "--diff", "d.png"});
  EXPECT_EQ(read_image(path("d.png")).width, 16);
  for (const char* limit : {"--max-mse", "--max-relmse", "--max-flip", "--max-mean-difference"}) {
    const Ending exceeded = run({"compare", "a.exr", "b.exr", limit, "0"});
    EXPECT_EQ(exceeded.exit_code, 1) << limit;
    EXPECT_TRUE(contains(exceeded.err, "more than 0")) << exceeded.err;
  }
  const Ending report = succeed({"compare", "a.exr", "b.exr", "--json", "-"});
  const nlohmann::json numbers = nlohmann::json::parse(report.out, nullptr, false);
  ASSERT_TRUE(numbers.is_object()) << report.out;
  EXPECT_GT(numbers["mse"], 0);
  EXPECT_EQ(numbers["width"], 16);

  refuse({"compare", "a.exr", "nosuch.exr"}, "nosuch.exr");
  refuse({"compare", "a.exr", "tiny.pbrt"}, "tiny.pbrt");
  refuse({"compare", "a.exr", "small.exr"}, "8 x 8");
  refuse({"compare", "a.exr", "b.exr", "--layer", "nosuch"}, "nosuch");
  refuse({"compare", "a.exr", "b.exr", "--require-agreement"}, "--sem");
}

TEST_F(Cli, DamagedScenesAreRenderedOrRefused) {
  std::mt19937 random(20261);  // portable, unlike the distributions of the standard library
  int refused = 0;
  for (int i = 0; i < 30; ++i) {  // more, for whole scenes: tests/fuzz/mutate_scenes.py
    std::string text = tiny_scene;
    const std::size_t changes = 1 + random() % 3;
    for (std::size_t k = 0; k < changes; ++k) {
      const std::size_t at = random() % text.size();
      const char byte = static_cast<char>(random() % 2 == 0 ? random() % 256 : ' ' + random() % 95);
      switch (random() % 3) {
        case 0:
          text[at] = byte;
          break;
        case 1:
          text.erase(at, 1);
          break;
        default:
          text.insert(at, 1, byte);
      }
    }
    dir_.write("mutant.pbrt", text);
    const Ending ending = run({"render", "mutant.pbrt", "-q", "-i", "path", "-p", "1", "-r", "8x8", "-o", "out.exr"});
    ASSERT_TRUE(ending.exit_code) << "mutant " << i << " died of signal " << ending.signal << '\n' << text;
    ASSERT_TRUE(ending.exit_code == 0 || ending.exit_code == 2) << "mutant " << i << ": " << ending.err << '\n' << text;
    EXPECT_EQ(fs::exists(path("out.exr")), ending.exit_code == 0) << "mutant " << i << ": " << ending.err;
    if (ending.exit_code == 2) {
      ++refused;
      EXPECT_TRUE(contains(ending.err, "mutant.pbrt")) << "mutant " << i << ": " << ending.err;
    }
    fs::remove(path("out.exr"));
  }
  EXPECT_GT(refused, 9);
  EXPECT_LT(refused, 30);
}

TEST_F(Cli, AutoSaysWhatItFoundAndChose) {
  const std::string said = succeed({"render", "tiny.pbrt", "-r", "16x16", "-p", "1", "-v", "-o", "a.exr", "-o",
                                    "a.state", "--json", "a.json"})
                               .err;
  for (const char* part : {"caustics make ", " light paths a pixel, merged in 100 %", "variance", "as it pays"})
    EXPECT_TRUE(contains(said, part)) << part << '\n' << said;
  const nlohmann::json found = json("a.json")["settings"]["findings"];
  EXPECT_GT(found["caustic_light"], 0);
  EXPECT_GT(found["light_paths_per_pixel"], 0);
  EXPECT_EQ(found["everywhere"].size(), 76u);
  for (const char* file : {"a.exr", "a.state"})
    EXPECT_TRUE(contains(succeed({"info", file}).out, "found      " + found["summary"].get<std::string>())) << file;
}

}  // namespace
}  // namespace lanthorn::cli_test
