// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Which method renders a scene, and which of the file's integrator parameters apply to it.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>

#include "lanthorn/methods.h"
#include "support/open_box.h"
#include "support/render_scene.h"

namespace lanthorn::default_method_test {
namespace {

// The method that a file names, and its name for -i.
const std::map<std::string, std::string> of_pbrt{{"ambientocclusion", "path"},
                                                 {"bdpt", "bdpt"},
                                                 {"lightpath", "light"},
                                                 {"mlt", "mlt"},
                                                 {"path", "path"},
                                                 {"randomwalk", "path"},
                                                 {"simplepath", "path"},
                                                 {"simplevolpath", "path"},
                                                 {"sppm", "sppm"},
                                                 {"volpath", "path"}};

RenderPlan plan_of(const std::string& header, const RenderOptions& options = {}) {
  return test::plan_render(test::scene_from_text(header + "\n" + test::camera + test::box), options);
}

TEST(DefaultMethod, IsAutoWhereTheFileNamesNone) {
  EXPECT_EQ(plan_of("").info->name, "auto");
  EXPECT_EQ(default_method("").notice, "");
  EXPECT_EQ(plan_of(R"(Integrator "radiosity")").info->name, "auto") << "the reader warns of the name";
  EXPECT_EQ(default_method("radiosity").notice, "");
}

TEST(DefaultMethod, IsAutoInPlaceOfPbrtsIntegratorsWithTheirDepthAndSamples) {
  for (const auto& [name, ours] : of_pbrt) {
    SCOPED_TRACE(name);
    const RenderPlan plan = plan_of("Integrator \"" + name + R"(" "integer maxdepth" 7
Sampler "halton" "integer pixelsamples" 5)");
    EXPECT_EQ(plan.info->name, "auto");
    EXPECT_EQ(plan.settings.max_depth, name == "sppm" ? 14 : 7);
    EXPECT_EQ(plan.stop.passes, (PassRange{0, 5}));
    EXPECT_EQ(default_method(name).notice,
              "method auto: in place of pbrt's \"" + name + "\", which the file names (-i " + ours + ": that method)");
  }
}

TEST(DefaultMethod, IsTheOneOfLanthornThatTheFileNames) {
  int count = 0;
  for (const IntegratorInfo& info : integrator_registry()) {
    if (of_pbrt.contains(info.name)) continue;
    EXPECT_EQ(plan_of("Integrator \"" + info.name + "\"").info->name, info.name);
    EXPECT_EQ(default_method(info.name).notice, "") << info.name;
    ++count;
  }
  EXPECT_GE(count, 8);
}

TEST(DefaultMethod, GivesWayToTheOptions) {
  RenderOptions options;
  for (const std::string method : {"path", "sppm", "probppm"}) {
    options.integrator = method;
    for (const std::string header : {"", R"(Integrator "sppm")", R"(Integrator "vcm")"})
      EXPECT_EQ(plan_of(header, options).info->name, method) << header;
  }
}

// The photon count of an sppm pass does not apply to the light paths of auto.
TEST(DefaultMethod, PhotonsOfAFileAreNotForAutoUnlessTheFileNamesIt) {
  const auto light_paths = [](const std::string& integrator, const RenderOptions& options) {
    return plan_of("Integrator \"" + integrator + R"(" "integer photonsperiteration" 1234)", options).settings.photons;
  };
  RenderOptions options;
  const std::uint64_t automatic = plan_of("").settings.photons;
  EXPECT_NE(automatic, 1234u);
  EXPECT_EQ(light_paths("sppm", options), automatic);
  EXPECT_EQ(light_paths("radiosity", options), automatic);
  EXPECT_EQ(light_paths("auto", options), 1234u);
  EXPECT_EQ(light_paths("probppm", options), 1234u);
  options.integrator = "auto";
  EXPECT_EQ(light_paths("sppm", options), automatic);
  EXPECT_EQ(light_paths("probppm", options), automatic);
  for (const std::string method : {"sppm", "vcm"}) {
    options.integrator = method;
    EXPECT_EQ(light_paths("sppm", options), 1234u) << method;
  }
  options.photons = 77;
  for (const std::string method : {"sppm", "auto"}) {
    options.integrator = method;
    EXPECT_EQ(light_paths("sppm", options), 77u) << method;
  }
}

// The radius of the file's sppm is a parameter that auto lacks; -i sppm uses it.
TEST(DefaultMethod, ParametersOfAFileAreForTheMethodsThatHaveThem) {
  const std::string header = R"(Integrator "sppm" "float radius" 0.125)";
  EXPECT_FALSE(plan_of(header).parameters.all().contains("radius"));
  RenderOptions options;
  options.integrator = "sppm";
  EXPECT_EQ(plan_of(header, options).parameters.all().at("radius"), "0.125");
}

}  // namespace
}  // namespace lanthorn::default_method_test
