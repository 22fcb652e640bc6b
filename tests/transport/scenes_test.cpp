// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Every scene of tests/scenes with every integrator: only finite values, no empty picture, equal bytes for any number
// of threads. The tests of the features check the content of the pictures. The scenes meant for users load without a
// warning and render with every integrator.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "integrators/integrator.h"
#include "lanthorn/scene.h"
#include "scene/medium_around.h"
#include "support/render_scene.h"

namespace lanthorn::scenes_test {
namespace {

std::vector<std::filesystem::path> scenes_in(const std::string& folder) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(LANTHORN_SOURCE_DIR "/" + folder))
    if (entry.path().extension() == ".pbrt") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

// Many gather rays would not improve this test. With so few photons, methods without gather rays show something in
// every scene only if the radii are large.
void choose(const IntegratorInfo& info, RenderOptions& options) {
  options.integrator = info.name;
  options.set.clear();
  for (const ParameterInfo& parameter : info.parameters)
    if (parameter.name == "gather") options.set["gather"] = "2";
  if (info.name == "bpm") options.set["radius"] = "0.5";
}

class TestScenes : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(TestScenes, RenderInEveryWay) {
  RenderOptions options;
  options.resolution = {48, 24};
  options.photons = 2000;
  options.passes = 2;
  options.max_depth = 12;
  const Scene scene(read_scene(GetParam()));
  for (const IntegratorInfo& info : integrator_registry())
    for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral}) {
      SCOPED_TRACE(std::string(info.name) + (color == ColorMode::rgb ? ", rgb" : ", spectral"));
      choose(info, options);
      options.color = color;
      std::vector<std::byte> one;
      {
        const ThreadLimit limit(1);
        const RenderState state = test::render_state(scene, options);
        EXPECT_TRUE(state.film.report().clean());
        const Image image = *select_layer(state.film.resolve(state.pass_count()), "color");
        // Split-sum shading shows only emitters and surfaces that the sky lights; some scenes have neither in view.
        const float least = info.name == "splitsum" ? -1 : 0.01f;
        EXPECT_GT(*std::max_element(image.pixels.begin(), image.pixels.end()), least);
        one = encode_state(state);
      }
      if (color == ColorMode::rgb) continue;  // determinism_test.cpp compares bytes in both modes
      const ThreadLimit limit(3);
      EXPECT_EQ(one, encode_state(test::render_state(scene, options)));
    }
}

RenderOptions one_small_pass() {
  RenderOptions options;
  options.resolution = {24, 24};
  options.photons = 1000;
  options.passes = 1;
  return options;
}

void expect_no_warnings(const Scene& scene) {
  for (const auto& warnings : {scene.warnings(), media_warnings(scene, make_view(scene.description().view))})
    for (const description::Warning& warning : warnings)
      ADD_FAILURE() << Error(warning.location, warning.message).what();
}

class Scenes : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Scenes, RenderWithoutWarnings) {
  RenderOptions options = one_small_pass();
  const Scene scene(read_scene(GetParam()));
  expect_no_warnings(scene);
  for (const IntegratorInfo& info : integrator_registry()) {
    SCOPED_TRACE(std::string(info.name));
    choose(info, options);
    const RenderState state = test::render_state(scene, options);
    EXPECT_TRUE(state.film.report().clean());
    EXPECT_EQ(state.pass_count(), 1u);
  }
}

// Large scenes without unique features: rendered by a single method.
class LargeScenes : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(LargeScenes, RenderWithoutWarnings) {
  RenderOptions options = one_small_pass();
  options.integrator = "path";
  const Scene scene(read_scene(GetParam()));
  expect_no_warnings(scene);
  const RenderState state = test::render_state(scene, options);
  EXPECT_TRUE(state.film.report().clean());
  const Image image = *select_layer(state.film.resolve(state.pass_count()), "color");
  EXPECT_GT(*std::max_element(image.pixels.begin(), image.pixels.end()), 0.01f);
}

std::string name_of(const testing::TestParamInfo<std::filesystem::path>& scene) {
  std::string name = scene.param.stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, TestScenes, testing::ValuesIn(scenes_in("tests/scenes")), name_of);
INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(scenes_in("scenes")), name_of);
INSTANTIATE_TEST_SUITE_P(Lectures, LargeScenes, testing::ValuesIn(scenes_in("scenes/lectures")), name_of);
INSTANTIATE_TEST_SUITE_P(Gallery, LargeScenes, testing::ValuesIn(scenes_in("scenes/gallery")), name_of);

}  // namespace
}  // namespace lanthorn::scenes_test
