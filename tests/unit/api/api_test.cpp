// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The public headers alone, as an embedding program uses them.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include "lanthorn/error.h"
#include "lanthorn/render.h"
#include "support/temporary_dir.h"

namespace {

lanthorn::RenderRequest small_request() {
  lanthorn::RenderRequest request;
  request.scene = LANTHORN_SOURCE_DIR "/scenes/cornell-caustics.pbrt";
  request.integrator = "path";
  request.passes = 3;
  request.width = 24;
  request.height = 16;
  return request;
}

TEST(Api, RendersALayeredPicture) {
  const lanthorn::Image image = lanthorn::render(small_request());
  EXPECT_EQ(image.width, 24);
  EXPECT_EQ(image.height, 16);
  const auto samples = image.find_channel("samples");
  ASSERT_TRUE(samples && image.find_channel("caustic.R") && image.find_channel("R"));
  EXPECT_FLOAT_EQ(image.at(5, 5, *samples), 3);
  double sum = 0;
  for (int x = 0; x < image.width; ++x) sum += static_cast<double>(image.at(x, 8, 0));
  EXPECT_GT(sum, 0.1);
}

TEST(Api, ProgressCanStopARender) {
  lanthorn::RenderRequest request = small_request();
  request.passes = 1000;
  std::uint64_t last = 0;
  request.progress = [&](std::uint64_t passes) { return (last = passes) < 2; };
  lanthorn::render(request);
  EXPECT_EQ(last, 2u);
}

TEST(Api, ASandboxedSceneReadsItsOwnFolderAlone) {
  const lanthorn::test::TemporaryDir dir;
  std::filesystem::create_directory(dir.path() / "upload");
  dir.write("outside.pbrt", "LightSource \"point\"\n");
  dir.write("upload/scene.pbrt", "WorldBegin\nInclude \"../outside.pbrt\"\nShape \"sphere\"\n");
  lanthorn::RenderRequest request = small_request();
  request.scene = dir.path() / "upload/scene.pbrt";
  EXPECT_NO_THROW(lanthorn::render(request));
  request.sandbox = true;
  EXPECT_THROW(lanthorn::render(request), lanthorn::Error);
}

TEST(Api, APictureThatDoesNotFitIntoMemoryIsRefused) {
  lanthorn::RenderRequest request = small_request();
  request.memory = 1000;
  EXPECT_THROW(lanthorn::render(request), lanthorn::Error);
}

// Stops at some time into a pass, again and again: the picture is that of the passes before.
TEST(Api, AStoppedPassLeavesNoTrace) {
  for (const char* const integrator :
       {"probppm", "sppm", "ppm", "vcm", "bpm", "bdpt", "path", "light", "mlt", "photonmap", "reversephotonmap"})
    for (const int delay : {2, 20}) {
      SCOPED_TRACE(integrator);
      lanthorn::RenderRequest request = small_request();
      request.integrator = integrator;
      request.passes = 1000;
      std::atomic<bool> stop{false};
      request.stop = &stop;
      std::uint64_t done = 0;
      std::thread stopper;
      request.progress = [&](std::uint64_t passes) {
        done = passes;
        if (passes == 2)
          stopper = std::thread([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(delay));
            stop = true;
          });
        return true;
      };
      const lanthorn::Image stopped = lanthorn::render(request);
      stopper.join();
      ASSERT_LT(done, 1000u);
      request.passes = done;
      request.stop = nullptr;
      request.progress = nullptr;
      EXPECT_EQ(stopped.pixels, lanthorn::render(request).pixels) << done << " passes, after " << delay << " ms";
    }
}

TEST(Api, WithoutAPassThereIsNoPicture) {
  const std::atomic<bool> stop{true};
  lanthorn::RenderRequest request = small_request();
  request.stop = &stop;
  EXPECT_THROW(lanthorn::render(request), lanthorn::Error);
}

TEST(Api, WarningsReachTheProgram) {
  const lanthorn::test::TemporaryDir dir;
  lanthorn::RenderRequest request = small_request();
  request.passes = 1;
  std::vector<std::string> warnings;
  request.warning = [&](const lanthorn::SourceLocation& where, const std::string& message) {
    warnings.push_back(std::to_string(where.line) + ":" + std::to_string(where.column) + " " + message);
    EXPECT_EQ(where.file, request.scene.string());
  };
  lanthorn::render(request);
  EXPECT_TRUE(warnings.empty()) << warnings.front();
  request.scene =
      dir.write("a.pbrt", "Camera \"perspective\"\nFilm \"rgb\"\n  \"string sensor\" \"canon_eos_5d\"\nWorldBegin\n");
  lanthorn::render(request);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "3:3 the measured sensor \"canon_eos_5d\" is not supported: replaced by \"cie1931\"");
  request.warning = nullptr;
  EXPECT_NO_THROW(lanthorn::render(request));
}

TEST(Api, WrongRequestsThrow) {
  lanthorn::RenderRequest request = small_request();
  request.integrator = "nosuch";
  EXPECT_THROW(lanthorn::render(request), lanthorn::Error);
  request = small_request();
  request.height.reset();
  EXPECT_THROW(lanthorn::render(request), lanthorn::Error);
}

}  // namespace
