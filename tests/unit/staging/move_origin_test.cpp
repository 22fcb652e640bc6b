// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A scene far from the origin renders as at the origin: everything with a world position moves with the camera.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "lanthorn/file.h"
#include "lanthorn/photons.h"
#include "support/render_scene.h"

namespace lanthorn::move_origin_test {
namespace {

const std::string folder = LANTHORN_SOURCE_DIR "/tests/scenes";
const DVec3 far_away(4321567.25, 8192, -5000.5);

void replace(std::string& text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  ASSERT_NE(at, std::string::npos) << old;
  text.replace(at, old.size(), by);
}

// The scene's text with everything but the camera's own transformation translated, before and after WorldBegin.
std::string moved(std::string text, const DVec3& way) {
  replace(text, "\nCamera ", fmt::format("\nTranslate {} {} {}\nCamera ", -way.x, -way.y, -way.z));
  replace(text, "\nWorldBegin", fmt::format("\nWorldBegin\nTranslate {} {} {}", way.x, way.y, way.z));
  return text;
}

RenderOptions few_passes() {
  RenderOptions options = test::options_for("path", 4);
  options.resolution = {48, 24};
  options.max_depth = 8;
  return options;
}

struct Case {
  const char* scene;
  float apart;  // largest share of pixels that may differ: paths part where a last digit chooses
};

class MovedOrigin : public testing::TestWithParam<Case> {};

TEST_P(MovedOrigin, ShowsTheSamePicture) {
  const std::string text = read_file(folder + "/" + GetParam().scene + ".pbrt");
  const Scene here(read_pbrt_string(text, folder, "here"));
  const Scene there(read_pbrt_string(moved(text, far_away), folder, "there"));
  EXPECT_EQ(here.description().origin, DVec3(0));
  EXPECT_LT(glm::length(there.description().origin - far_away), 70000);
  const Image a = *select_layer(test::render_image(here, few_passes()), "color");
  const Image b = *select_layer(test::render_image(there, few_passes()), "color");
  std::size_t apart = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    apart += std::fabs(a.pixels[i] - b.pixels[i]) > .01f * std::max(a.pixels[i], .01f) ? 1 : 0;
  EXPECT_LT(static_cast<float>(apart), GetParam().apart * static_cast<float>(a.pixels.size()));
  const auto sum = [](const Image& image) { return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0); };
  EXPECT_NEAR(sum(b) / sum(a), 1, .03);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MovedOrigin,
                         testing::Values(Case{"textures", .04f}, Case{"lights", .04f}, Case{"media", .04f},
                                         Case{"shapes", .04f}, Case{"subdivision", .04f},
                                         // Coats and hairs draw random numbers that depend on the digits of directions.
                                         Case{"materials", .3f}, Case{"curves", .6f}),
                         [](const auto& moved_scene) { return std::string(moved_scene.param.scene); });

TEST(MoveOrigin, MovesInstancesAndKeepsObjects) {
  const SceneDescription scene = read_pbrt_string(
      R"(LookAt 0 0 2000  0 0 0  0 1 0
Camera "perspective"
WorldBegin
ObjectBegin "o"
Translate 1 2 3 Shape "sphere"
ObjectEnd
Translate 0 0 2000 ObjectInstance "o"
)",
      ".", "instance");
  EXPECT_EQ(scene.origin, DVec3(0, 0, 2000));
  EXPECT_EQ(DVec3(scene.objects.at(0).shapes.at(0).object_to_world.start.matrix[3]), DVec3(1, 2, 3));
  EXPECT_EQ(DVec3(scene.instances.at(0).object_to_world.start.matrix[3]) + scene.origin, DVec3(0, 0, 2000));
}

TEST(MoveOrigin, LeavesNearCamerasAlone) {
  SceneDescription scene = read_pbrt_string(
      R"(LookAt 900 0 -900  0 0 0  0 1 0
Camera "perspective"
WorldBegin
Shape "sphere"
)",
      ".", "near");
  EXPECT_EQ(scene.origin, DVec3(0));
  EXPECT_EQ(scene.view.camera.camera_to_world.start.matrix[3], glm::dvec4(900, 0, -900, 1));
}

TEST(MoveOrigin, MovesPortals) {
  const std::string portal =
      R"(LightSource "infinite" "rgb L" [1 1 1] "point3 portal" [4999 0 0 5001 0 0 5001 2 0 4999 2 0]
)";
  const SceneDescription scene = read_pbrt_string(
      R"(LookAt 5000 1 3  5000 1 0  0 1 0
Camera "perspective"
WorldBegin
)" + portal,
      ".", "portal");
  EXPECT_EQ(scene.origin, DVec3(4992, 0, 0));
  const auto& sky = std::get<description::InfiniteLight>(scene.lights.at(0).node);
  ASSERT_TRUE(sky.portal);
  EXPECT_EQ(DVec3((*sky.portal)[0]) + scene.origin, DVec3(4999, 0, 0));
  EXPECT_EQ(DVec3((*sky.portal)[2]) + scene.origin, DVec3(5001, 2, 0));
}

TEST(MoveOrigin, PhotonsAndBoundsKeepTheCoordinatesOfTheFile) {
  const Scene scene(read_pbrt_string(
      R"(LookAt 8000 3 -6  8000 0 0  0 1 0
Camera "perspective"
WorldBegin
Translate 8000 0 0
LightSource "point" "point3 from" [0 2 0]
Shape "trianglemesh" "point3 P" [-1 0 -1 1 0 -1 1 0 1 -1 0 1] "integer indices" [0 1 2 0 2 3]
)",
      ".", "far"));
  EXPECT_NE(scene.description().origin.x, 0);
  RenderOptions options = test::options_for("probppm", 1);
  options.photons = 200;
  const Photons photons = trace_photons(scene, scene.description().view, options, 0, true);
  ASSERT_GT(photons.size(), 0u);
  for (const Point& p : photons.positions) EXPECT_NEAR(p.x, 8000, 1);
  EXPECT_NEAR(summarize(scene).bounds.min.x, 7999, 1e-3);
}

TEST(MoveOrigin, WarnsWhereStepsOfCoordinatesShow) {
  const auto warning_of = [](const std::string& head, const std::string& shape) {
    const Scene scene(read_pbrt_string(head + R"(Camera "perspective"
WorldBegin
)" + shape,
                                       ".", "coarse"));
    std::string found;
    for (const description::Warning& w : scene.warnings()) found += w.message;
    return found;
  };
  const std::string ball = R"(Translate 50000 0 0 Shape "sphere" "float radius" .01
)";
  const std::string found = warning_of("", ball);
  EXPECT_NE(found.find("has a size of 0.031 m, but coordinates around 50000 m, which are rounded to 0.004 m"),
            std::string::npos)
      << found;
  EXPECT_EQ(warning_of("LookAt 50000 0 1  50000 0 0  0 1 0\n", ball), "");
  // A shift of the origin cannot undo rounding in the file itself.
  EXPECT_NE(warning_of("LookAt 50000 0 1  50000 0 0  0 1 0\n",
                       R"(Shape "trianglemesh" "point3 P" [50000 0 0 50000.02 0 0 50000 .02 0]
)"),
            "");
}

}  // namespace
}  // namespace lanthorn::move_origin_test
