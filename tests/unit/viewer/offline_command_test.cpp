// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The `render` command line that reproduces the window's content.
#include "viewer/offline_command.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <variant>

namespace lanthorn::offline_command_test {
namespace {

using Set = std::map<std::string, std::string>;

ShownPicture shown(const std::string& method) {
  ShownPicture picture;
  picture.scene = "a room.pbrt";
  picture.method = method;
  picture.width = 64;
  picture.height = 48;
  return picture;
}

TEST(OfflineRender, IsByTheMethodThatShowsTheSame) {
  const ViewerOptions options;
  const RenderOptions vcm = offline_render(shown("vcm"), options).options;
  EXPECT_EQ(vcm.integrator, "vcm");
  EXPECT_EQ(vcm.resolution, (std::array{64, 48}));
  EXPECT_TRUE(vcm.set.empty());
  EXPECT_EQ(offline_render(shown("ambient"), options).options.integrator, "path");
  EXPECT_FALSE(offline_render(shown("ambient"), options).options.max_depth);
  const RenderOptions direct = offline_render(shown("direct"), options).options;
  EXPECT_EQ(direct.integrator, "path");
  EXPECT_EQ(direct.max_depth, 1);
  ShownPicture cones = shown("voxelcones");
  const RenderOptions by_cones = offline_render(cones, options).options;
  EXPECT_EQ(by_cones.integrator, "voxelcones");
  EXPECT_FALSE(by_cones.photons);
  EXPECT_EQ(by_cones.set, (Set{{"voxels", "32"}, {"shadows", "maps"}})) << "what differs from the defaults of render";
  cones.settings.values = {{"voxels", "64"}, {"grids", "3"}, {"shadows", "traced"}, {"map", "512"}};
  EXPECT_EQ(offline_render(cones, options).options.set, (Set{{"grids", "3"}, {"map", "512"}}));
  ShownPicture photons = shown("ispm");
  photons.settings.values = {{"radius", "0.123456789"}, {"gather", "auto"}};
  const RenderOptions by_photons = offline_render(photons, options).options;
  EXPECT_EQ(by_photons.photons, 20000u);
  EXPECT_EQ(by_photons.set, (Set{{"radius", "0.1235"}, {"shadows", "maps"}}));
  EXPECT_TRUE(offline_render(shown("splitsum"), options).options.set.empty());
}

TEST(OfflineRender, IsDenoisedAsThePictureIs) {
  ShownPicture picture = shown("vcm");
  EXPECT_FALSE(offline_render(picture, {}).denoises);
  picture.denoises = true;
  EXPECT_TRUE(offline_render(picture, {}).denoises);
}

// The viewer's own command line also affects the picture.
TEST(OfflineRender, HasWhatTheViewerWasStartedWith) {
  ViewerOptions options;
  options.method = "probppm";
  options.render.photons = 7000;
  options.render.seed = 3;
  options.render.set = {{"radius", "0.01"}};
  options.render.max_depth = 5;
  options.render.crop = {0, 0, 8, 8};
  const RenderOptions same = offline_render(shown("probppm"), options).options;
  EXPECT_EQ(same.photons, 7000u);
  EXPECT_EQ(same.seed, 3u);
  EXPECT_EQ(same.set, options.render.set);
  EXPECT_EQ(same.max_depth, 5);
  EXPECT_EQ(same.crop, options.render.crop);
  const RenderOptions other = offline_render(shown("vcm"), options).options;
  EXPECT_EQ(other.photons, 7000u);
  EXPECT_TRUE(other.set.empty()) << "parameters are those of another method";
  const RenderOptions direct = offline_render(shown("direct"), options).options;
  EXPECT_FALSE(direct.photons);
  EXPECT_EQ(direct.max_depth, 1);
  EXPECT_EQ(direct.crop, options.render.crop);
}

TEST(OfflineRender, HasTheCameraAndTheDisplay) {
  ShownPicture picture = shown("path");
  picture.scene = "room.pbrt.gz";
  picture.camera = CameraPose{translate({0, 0, -4}), 4, {0, 1, 0}};
  picture.display.exposure = 1.5f;
  picture.display.curve = ToneCurve::filmic;
  const ShownRender render = offline_render(picture, {});
  EXPECT_EQ(render.scene, "room.pbrt.gz");
  EXPECT_EQ(render.picture, "room.png");
  EXPECT_EQ(render.look, (LookAt{{0, 0, -4}, {0, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(render.display.exposure, 1.5f);
  EXPECT_EQ(render.display.curve, ToneCurve::filmic);
  EXPECT_FALSE(offline_render(shown("path"), {}).look);
}

TEST(OfflineRender, HasTheStrengthsOfLights) {
  LightRow dim, off, same;
  dim.id = "light1";
  dim.strength = 0.25f;
  off.id = "area1";
  off.on = false;
  same.id = "light2";
  ShownPicture picture = shown("path");
  picture.strengths = strengths_of({dim, off, same});
  EXPECT_EQ(offline_render(picture, {}).light_factors, (std::map<std::string, float>{{"area1", 0}, {"light1", 0.25f}}));
}

TEST(OfflineRender, HasTheExposureOfThePanel) {
  ShownPicture picture = shown("vcm");
  picture.display.exposure = -1.5f;
  EXPECT_FALSE(offline_render(picture, {}).measures_exposure);
  EXPECT_EQ(offline_render(picture, {}).display.exposure, -1.5f);
  picture.measures_exposure = true;
  EXPECT_TRUE(offline_render(picture, {}).measures_exposure);
}

// Light strengths given at the start count as edits: they are saved with the scene.
TEST(OfflineRender, StrengthsAtTheStartAreEdits) {
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
