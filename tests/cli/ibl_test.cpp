// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "cli_fixture.h"
#include "lanthorn/image.h"

namespace lanthorn::ibl_test {
namespace {

class CliIbl : public Cli {
 protected:
  CliIbl() {
    Image sky(64, 32, {"R", "G", "B"});
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 64; ++x)
        for (std::size_t c = 0; c < 3; ++c) sky.at(x, y, c) = y < 16 ? 1.0f + static_cast<float>(c) : 0.25f;
    sky.at(20, 12, 0) = 1e6f;
    write_exr(path("sky.exr"), sky);
  }
  static Words bake(const Words& more) {
    return Words{"ibl", "sky.exr", "-o", "out", "-q", "--size", "32", "--smallest", "8"} + more;
  }
  Words made() const {
    Words names;
    for (const std::string& name : files())
      if (name.starts_with("out/")) names.push_back(name.substr(4));
    return names;
  }
};

TEST_F(CliIbl, WritesAllMapsByTheirNames) {
  succeed(bake({}));
  EXPECT_EQ(made(), (Words{"brdf.dds", "brdf.exr", "brdf.ktx2", "contact.png", "irradiance.dds", "irradiance.exr",
                           "irradiance.ktx2", "report.json", "sh.json", "specular-0.exr", "specular-1.exr",
                           "specular-2.exr", "specular.dds", "specular.ktx2"}));
  const Image level = read_image(path("out/specular-1.exr"));
  EXPECT_EQ(level.width, 6 * 16);
  EXPECT_EQ(level.height, 16);
  EXPECT_EQ(read_image(path("out/brdf.exr")).width, 128);
  EXPECT_EQ(metadata_of("out/specular-1.exr")["alphas"], "0 0.25 1");
  EXPECT_TRUE(contains(metadata_of("out/irradiance.exr")["map"], "irradiance over pi"));
  const nlohmann::json report = json("out/report.json");
  EXPECT_EQ(report["environment"]["layout"], "equirectangular");
  EXPECT_EQ(report["suns"]["texels"], 1);
  EXPECT_GT(report["suns"]["share_of_flux"][0], 0.9);
  EXPECT_LT(report["suns"]["share_of_flux"][1], 0.01);
  ASSERT_EQ(report["specular"].size(), 3u);
  EXPECT_EQ(report["specular"][1]["alpha"], 0.25);
  EXPECT_LT(report["specular"][1]["error"]["rms"], 0.05);
  EXPECT_EQ(report["specular"][1]["error"]["places"], 8);
  const nlohmann::json sh = json("out/sh.json");
  EXPECT_EQ(sh["irradiance_over_pi"]["order2"].size(), 9u);
  EXPECT_EQ(sh["radiance"]["order3"].size(), 16u);
  EXPECT_GT(sh["radiance"]["order2"][1][1], 0.5) << "brighter above";
}

TEST_F(CliIbl, WritesWhatIsAskedFor) {
  succeed(bake({"--maps", "specular,brdf", "--formats", "ktx2", "--brdf-size", "16"}));
  EXPECT_EQ(made(), (Words{"brdf.ktx2", "contact.png", "report.json", "specular.ktx2"}));
}

TEST_F(CliIbl, PrintsItsReport) {
  const Ending ending = succeed(bake({"--maps", "sh,brdf", "--json"}));
  EXPECT_EQ(ending.out, bytes("out/report.json"));
  const nlohmann::json report = nlohmann::json::parse(ending.out);
  EXPECT_LT(report["brdf"]["error"]["max"], 2e-3);
  EXPECT_LT(report["sh"]["error"]["rms"], 0.2);
}

TEST_F(CliIbl, WritesAllFilesOrNone) {
  // The limit (100 KB) allows sh.json and contact.png, but not the table.
  const auto limited = [&] {
    const Ending ending = run_shell("ulimit -f 200; L ibl sky.exr -o out -q --maps sh,brdf --formats ktx2");
    EXPECT_EQ(ending.exit_code, 2);
    EXPECT_TRUE(contains(ending.err, "File too large")) << ending.err;
  };
  limited();
  EXPECT_FALSE(fs::exists(path("out")));
  succeed(bake({"--maps", "sh"}));
  const std::string old = bytes("out/sh.json"), report = bytes("out/report.json");
  const Words before = made();
  limited();
  EXPECT_EQ(made(), before);
  EXPECT_EQ(bytes("out/sh.json"), old);
  EXPECT_EQ(bytes("out/report.json"), report);
}

TEST_F(CliIbl, LeavesNothingIfASignalEndsIt) {
  ChildProcess long_bake(LANTHORN_PROGRAM, {"ibl", "sky.exr", "-o", "out", "-q", "--samples", "1000000"}, dir_.path());
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  long_bake.send(SIGINT);
  EXPECT_EQ(long_bake.wait().signal, SIGINT);
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(CliIbl, NeedsNoEnvironmentForTheTable) {
  succeed({"ibl", "-o", "out", "--maps", "brdf", "--formats", "exr", "--sheen", "--brdf-size", "32"});
  EXPECT_EQ(made(), (Words{"brdf.exr", "report.json"}));
  EXPECT_GT(read_image(path("out/brdf.exr")).at(16, 24, 2), 0.01f);
  refuse({"ibl", "-o", "new", "--maps", "sh"}, "ENV: an environment is needed");
}

TEST_F(CliIbl, WritesTheSameBytesAgain) {
  succeed(bake({"-T", "1"}));
  const std::string first = bytes("out/specular.ktx2"), report = bytes("out/report.json");
  succeed(bake({"-T", "2"}));
  EXPECT_TRUE(bytes("out/specular.ktx2") == first);
  EXPECT_EQ(bytes("out/report.json"), report);
}

TEST_F(CliIbl, WarnsOfValuesThatTexelsCannotHold) {
  EXPECT_TRUE(contains(succeed(bake({"--maps", "specular", "--formats", "dds"})).err, "values are larger than 65504"));
  EXPECT_EQ(succeed(bake({"--maps", "specular", "--formats", "exr"})).err, "");
}

TEST_F(CliIbl, ReadsSixFaces) {
  Words words{"ibl"};
  for (int face = 0; face < 6; ++face) {
    const std::string name = "face" + std::to_string(face) + ".exr";
    Image image(16, 16, {"R", "G", "B"});
    std::fill(image.pixels.begin(), image.pixels.end(), face == 2 ? 1.0f : 0.0f);
    write_exr(path(name), image);
    words.push_back(name);
  }
  succeed(words + Words{"-o", "out", "-q", "--maps", "irradiance", "--formats", "exr"});
  const Image map = read_image(path("out/irradiance.exr"));
  EXPECT_GT(map.at(2 * 32 + 16, 16, 0), 0.5f) << "a surface that faces the bright face";
  EXPECT_NEAR(map.at(3 * 32 + 16, 16, 0), 0, 1e-6f);
}

TEST_F(CliIbl, RefusesWhatIsNoEnvironmentAndWritesNothing) {
  dir_.write("cut.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 512 +X 1024\n\x02\x02\x04");
  refuse({"ibl", "cut.hdr", "-o", "out"}, "cut.hdr");
  dir_.write("cut.exr", bytes("sky.exr").substr(0, bytes("sky.exr").size() / 2));
  refuse({"ibl", "cut.exr", "-o", "out"}, "cut.exr");
  dir_.write("huge.pfm", "PF\n2000000 1000000\n-1.0\n1234");
  refuse({"ibl", "huge.pfm", "-o", "out"}, "huge.pfm");
  dir_.write("text.hdr", "not a picture");
  refuse({"ibl", "text.hdr", "-o", "out"}, "text.hdr");
  refuse({"ibl", "missing.hdr", "-o", "out"}, "missing.hdr: no such file");
  write_exr(path("odd.exr"), Image(50, 20, {"R", "G", "B"}));
  refuse({"ibl", "odd.exr", "-o", "out"}, "odd.exr: is not an environment: it is 50 x 20 pixels");
  write_exr(path("black.exr"), Image(64, 32, {"R", "G", "B"}));
  refuse({"ibl", "black.exr", "-o", "out"}, "black.exr: is not an environment: it holds no light");
  dir_.write("empty.hdr", "");
  refuse({"ibl", "empty.hdr", "-o", "out"}, "empty.hdr: the file is not a supported image");
  dir_.write("nowhere.pfm", "PF\n0 0\n-1.0\n");
  refuse({"ibl", "nowhere.pfm", "-o", "out"}, "nowhere.pfm: the file is empty");
}

TEST_F(CliIbl, RefusesBadOptions) {
  refuse({"ibl", "sky.exr", "-o", "out", "-q", "--size", "48"},
         "the size of the specular map is 48; it must be a power of two");
  refuse(bake({"--formats", "png"}), "png");
  refuse(bake({"--maps", "diffuse"}), "diffuse");
  refuse({"ibl", "sky.exr", "-o", "."}, "holds the environment itself");
  refuse({"ibl", "sky.exr", "-o", "tiny.pbrt"}, "is a file; give a folder");
  refuse({"ibl", "sky.exr", "-q", "-o", "no/where"}, "create the folder above it first");
}

}  // namespace
}  // namespace lanthorn::ibl_test
