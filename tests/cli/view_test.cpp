// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// `lanthorn view` without a window, and on machines where it cannot open one.
#include <algorithm>
#include <fstream>

#include "cli_fixture.h"

namespace lanthorn::view_test {
namespace {

class View : public Cli {
 protected:
  /// Draws frames without a window; returns false if OpenGL is not available.
  bool draws(const Words& more, const std::string& output) const {
    const Ending ending = run(Words{"view", "tiny.pbrt", "--headless", "-n", "500", "-o", output} + more);
    if (*ending.exit_code == 2 && contains(ending.err, "OpenGL 4.5 core is needed")) return false;
    EXPECT_EQ(*ending.exit_code, 0) << ending.err;
    return true;
  }
};

TEST_F(View, HeadlessFramesAreTheSameBytesOnEveryRun) {
  const Words words{"--passes", "3", "--json", "a.json"};
  if (!draws(words, "a.exr")) GTEST_SKIP() << "SKIPPED, NOT TESTED: no OpenGL 4.5";
  draws(words, "b.exr");
  const auto report = json("a.json");
  EXPECT_EQ(report["frames"], 3);
  EXPECT_FALSE(report["stages"].empty());
  EXPECT_FALSE(report["photons_per_bounce"].empty());
  if (!report["software"]) GTEST_SKIP() << "SKIPPED, NOT TESTED: equal bytes are promised for OpenGL in software";
  EXPECT_EQ(bytes("a.exr"), bytes("b.exr"));
  draws({"--passes", "3", "--seed", "1"}, "c.exr");
  EXPECT_NE(bytes("a.exr"), bytes("c.exr"));
}

TEST_F(View, MethodsDifferAndOfflineOnesAreThoseOfRender) {
  if (!draws({"--passes", "1", "-i", "direct"}, "direct.exr")) GTEST_SKIP() << "SKIPPED, NOT TESTED: no OpenGL 4.5";
  draws({"--passes", "1", "-i", "ambient"}, "ambient.exr");
  draws({"--passes", "2", "-i", "path"}, "path.exr");
  EXPECT_EQ(run({"render", "tiny.pbrt", "-i", "path", "-p", "2", "-n", "500", "-o", "render.exr"}).exit_code, 0);
  const Image direct = read_image(path("direct.exr")), ambient = read_image(path("ambient.exr"));
  EXPECT_NE(direct.pixels, ambient.pixels);
  EXPECT_EQ(read_image(path("path.exr")).channels, read_image(path("render.exr")).channels);
  EXPECT_EQ(read_image(path("path.exr")).pixels, read_image(path("render.exr")).pixels);
}

TEST_F(View, OfflinePicturesAreDenoisedAsByRender) {
  const Words words{"-i", "path", "-p", "3", "--denoise"};
  for (const std::string extension : {".exr", ".png"}) {
    succeed(Words{"render", "tiny.pbrt", "-n", "500", "-o", "render" + extension, "-q"} + words);
    succeed(Words{"view", "tiny.pbrt", "-n", "500", "--headless", "-o", "view" + extension} + words);
    const Image render = read_image(path("render" + extension)), view = read_image(path("view" + extension));
    EXPECT_EQ(view.channels, render.channels);
    EXPECT_EQ(view.pixels, render.pixels);
  }
  EXPECT_TRUE(read_image(path("view.exr")).find_channel("denoised.direct.R"));
  const Ending single = run({"view", "tiny.pbrt", "--headless", "-i", "path", "-p", "1", "--denoise", "-o", "a.png"});
  EXPECT_EQ(*single.exit_code, 0);
  EXPECT_TRUE(contains(single.err, "a picture of a single pass is not denoised")) << single.err;
  refuse({"view", "tiny.pbrt", "--headless", "-p", "2", "--denoise", "-o", "b.png"},
         "ispm draws by OpenGL: only pictures of offline methods can be denoised");
  EXPECT_FALSE(fs::exists(path("b.png")));
}

TEST_F(View, WithoutDisplayItNamesTheBrowser) {
  const Ending window = run_shell("unset DISPLAY WAYLAND_DISPLAY; L view tiny.pbrt");
  EXPECT_EQ(*window.exit_code, 2);
  EXPECT_TRUE(contains(window.err, "no window can be opened")) << window.err;
  EXPECT_TRUE(contains(window.err, "lanthorn serve tiny.pbrt")) << window.err;
  const Ending headless =
      run_shell("export __EGL_VENDOR_LIBRARY_DIRS=/nonexistent; L view tiny.pbrt --headless --passes 1 -o a.png");
  EXPECT_EQ(*headless.exit_code, 2);
  const auto render = run_shell("export __EGL_VENDOR_LIBRARY_DIRS=/nonexistent; L render tiny.pbrt -i ispm -o a.png");
  EXPECT_EQ(*render.exit_code, 2);
  EXPECT_TRUE(contains(render.err, "OpenGL 4.5 core is needed")) << render.err;
  EXPECT_TRUE(contains(headless.err, "lanthorn serve tiny.pbrt")) << headless.err;
  EXPECT_FALSE(fs::exists(path("a.png")));
}

// The program explains surprising pictures.
TEST_F(View, DarkPicturesAreExplained) {
  const auto warnings = [&](const std::string& content) {
    std::ofstream(path("dark.pbrt")) << R"(LookAt 0 0 3  0 0 0  0 1 0
Camera "perspective"
Film "rgb" "integer xresolution" [8] "integer yresolution" [8]
WorldBegin
)" << content << R"(Shape "sphere"
)";
    return run({"view", "dark.pbrt", "--headless", "--passes", "1", "-n", "500", "-o", "dark.png"}).err;
  };
  const std::string unlit = warnings("");
  if (contains(unlit, "OpenGL 4.5 core is needed")) GTEST_SKIP() << "SKIPPED, NOT TESTED: no OpenGL 4.5";
  EXPECT_TRUE(contains(unlit, "the scene has no lights")) << unlit;
  const std::string sky = R"(LightSource "infinite"
)";
  EXPECT_EQ(warnings(sky), "");
  const std::string metal = warnings(sky + R"(Material "conductor" "float roughness" [.1]
)");
  EXPECT_TRUE(contains(metal, "appear slowly")) << metal;
  const std::string mirror = warnings(sky + R"(Material "conductor" "float roughness" [.01]
)");
  // A single frame of a mirror may be too bright in places; that is the only warning allowed.
  EXPECT_TRUE(mirror.empty() || contains(mirror, "brighter than white")) << mirror;
  EXPECT_LE(std::count(mirror.begin(), mirror.end(), '\n'), 1) << mirror;
  std::ofstream(path("slide.ppm")) << "P3 2 1 255  255 0 0  0 0 255\n";
  EXPECT_EQ(warnings(R"(AreaLightSource "diffuse" "string filename" "slide.ppm"
)"),
            "");
  const std::string goniometric = warnings(sky + R"(LightSource "goniometric" "string filename" "slide.ppm"
)");
  EXPECT_TRUE(contains(goniometric, "goniometric lights")) << goniometric;
}

TEST_F(View, BadOptionsSayWhatWasExpected) {
  const auto refuses = [&](const Words& words, const std::string& part) {
    refuse(Words{"view", "tiny.pbrt"} + words, part);
  };
  refuses({"--headless", "--passes", "1"}, "expected -o FILE");
  refuses({"--headless", "-o", "a.png"}, "expected --passes N");
  refuses({"-o", "a.png"}, "goes with --headless");
  refuses({"-i", "photons"}, "expected direct, ambient, ispm, splitsum, voxelcones, or an offline method");
  refuses({"--look-at", "0,0,0,0,0,0,0,1,0"}, "must not lie on one line");
  refuses({"--look-at", "0,0,1"}, "expected nine numbers");
  refuses({"--headless", "--passes", "1", "-o", "a.png", "--set", "gather=sieve"}, "expected auto, splat or tiles");
  EXPECT_FALSE(fs::exists(path("a.png")));
}

TEST_F(View, LookAtIsTheCameraOfTheFile) {
  const Words words{"-i", "path", "-p", "1", "--reproducible"};
  EXPECT_EQ(run(Words{"render", "tiny.pbrt", "-o", "a.exr"} + words).exit_code, 0);
  EXPECT_EQ(run(Words{"render", "tiny.pbrt", "-o", "b.exr", "--look-at", "0,1,4.4,0,1,0,0,1,0"} + words).exit_code, 0);
  EXPECT_EQ(run(Words{"render", "tiny.pbrt", "-o", "c.exr", "--look-at", "0,1,4,0,1,0,0,1,0"} + words).exit_code, 0);
  EXPECT_EQ(read_image(path("a.exr")).pixels, read_image(path("b.exr")).pixels);
  EXPECT_NE(read_image(path("a.exr")).pixels, read_image(path("c.exr")).pixels);
}

}  // namespace
}  // namespace lanthorn::view_test
