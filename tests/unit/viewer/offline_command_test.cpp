// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The command line that renders offline what the window shows.
#include "viewer/offline_command.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>

namespace lanthorn::offline_command_test {
namespace {

ShownPicture shown(const std::string& method) {
  ShownPicture picture;
  picture.scene = "a room.pbrt";
  picture.method = method;
  picture.width = 64;
  picture.height = 48;
  return picture;
}

TEST(OfflineCommand, NamesTheMethodThatShowsTheSame) {
  const ViewerOptions options;
  const std::string begin = "lanthorn render 'a room.pbrt'", end = " -r 64x48 -o 'a room.png'";
  EXPECT_EQ(offline_command(shown("vcm"), options), begin + " -i vcm" + end);
  EXPECT_EQ(offline_command(shown("ambient"), options), begin + " -i path" + end);
  EXPECT_EQ(offline_command(shown("direct"), options), begin + " -i path -r 64x48 -d 1 -o 'a room.png'");
  ShownPicture cones = shown("voxelcones");
  EXPECT_EQ(offline_command(cones, options), begin + " -i voxelcones --set voxels=32 --set shadows=maps" + end)
      << "what differs from the defaults of render";
  cones.settings.values = {{"voxels", "64"}, {"grids", "3"}, {"shadows", "traced"}, {"map", "512"}};
  EXPECT_EQ(offline_command(cones, options), begin + " -i voxelcones --set grids=3 --set map=512" + end);
  ShownPicture photons = shown("ispm");
  photons.settings.values = {{"radius", "0.123456789"}, {"gather", "auto"}};
  EXPECT_EQ(offline_command(photons, options),
            begin + " -i ispm -n 20000 --set radius=0.1235 --set shadows=maps" + end);
  EXPECT_EQ(offline_command(shown("splitsum"), options), begin + " -i splitsum" + end);
}

// What the viewer was started with decides the picture, too.
TEST(OfflineCommand, HasWhatTheViewerWasStartedWith) {
  ViewerOptions options;
  options.method = "probppm";
  options.render.photons = 7000;
  options.render.seed = 3;
  options.render.set = {{"radius", "0.01"}};
  options.render.max_depth = 5;
  options.command_options = " --crop 0,0,8,8";
  EXPECT_EQ(
      offline_command(shown("probppm"), options),
      "lanthorn render 'a room.pbrt' -i probppm -n 7000 --set radius=0.01 -r 64x48 --seed 3 -d 5 --crop 0,0,8,8 -o "
      "'a room.png'");
  EXPECT_EQ(offline_command(shown("vcm"), options),
            "lanthorn render 'a room.pbrt' -i vcm -n 7000 -r 64x48 --seed 3 -d 5 --crop 0,0,8,8 -o 'a room.png'")
      << "parameters are those of another method";
  EXPECT_EQ(offline_command(shown("direct"), options),
            "lanthorn render 'a room.pbrt' -i path -r 64x48 --seed 3 -d 1 --crop 0,0,8,8 -o 'a room.png'");
}

TEST(OfflineCommand, HasTheCameraAndTheDisplay) {
  ShownPicture picture = shown("path");
  picture.scene = "room.pbrt.gz";
  picture.camera = CameraPose{translate({0, 0, -4}), 4, {0, 1, 0}};
  picture.display.exposure = 1.5f;
  picture.display.curve = ToneCurve::filmic;
  EXPECT_EQ(offline_command(picture, {}),
            "lanthorn render room.pbrt.gz --look-at 0,0,-4,0,0,0,0,1,0 -i path -r 64x48 --exposure 1.50 --filmic -o "
            "room.png");
}

TEST(OfflineCommand, HasTheStrengthsOfLights) {
  LightRow dim, off, same;
  dim.id = "light1";
  dim.strength = 0.25f;
  off.id = "area1";
  off.on = false;
  same.id = "light2";
  ShownPicture picture = shown("path");
  picture.strengths = strengths_of({dim, off, same});
  EXPECT_EQ(offline_command(picture, {}),
            "lanthorn render 'a room.pbrt' -i path -r 64x48 --light area1=0 --light light1=0.25 -o 'a room.png'");
}

// Strengths with which the viewer starts are edits: they are saved with the scene.
TEST(OfflineCommand, StrengthsAtTheStartAreEdits) {
  const SharedScene scene = build_scene(read_pbrt_string(R"(Camera "perspective"
WorldBegin
LightSource "point" "rgb I" [5 2.5 1] "float scale" [2]
LightSource "distant" "rgb L" [1 1 1]
Shape "sphere"
)",
                                                         ".", "scene.pbrt"));
  const EditedScene edited(scene, {{"light1", 0.5f}, {"light2", 0}});
  ASSERT_TRUE(edited.is_edited());
  EXPECT_EQ(edited.lights()[0].strength, 0.5f);
  EXPECT_TRUE(edited.lights()[0].on);
  EXPECT_FALSE(edited.lights()[1].on);
  const auto& point = std::get<description::PointLight>(description_of(*edited.scene()).lights[0].node);
  EXPECT_FLOAT_EQ(point.intensity.scale, 1);
  EXPECT_FALSE(EditedScene(scene, {{"light1", 1}}).is_edited());
}

}  // namespace
}  // namespace lanthorn::offline_command_test
