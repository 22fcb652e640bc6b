// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A user-defined technique: one class with its TechniqueInfo. The frame, its parameters in `view` and `render`, the
// panel's command and the passes of a render work without further code.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/viewer.h"
#include "realtime/frame/renderer.h"
#include "support/error_text.h"
#include "support/opengl.h"
#include "support/render_scene.h"
#include "viewer/offline_command.h"
#include "viewer/realtime_view.h"

namespace lanthorn::own_technique_test {
namespace {

// Gives all pixels the same indirect light. Eye paths find twice as much at diffuse surfaces.
class Flood final : public Technique {
 public:
  void prepare(const FrameContext& frame) override { views_before_ = frame.light_views.size(); }
  void draw(const FrameContext& frame) override {
    const auto level = static_cast<float>(frame.settings.technique.number("flood"));
    const std::array<GLfloat, 4> light{level, level, level, 1};
    glClearNamedFramebufferfv(frame.targets.indirect.name(), GL_COLOR, 0, light.data());
    frame.report.photons_per_bounce = {views_before_, frame.settings.photons};
  }
  VertexLight light_at_vertices(const FrameContext& frame) override {
    const auto level = static_cast<float>(frame.settings.technique.number("flood"));
    return [level](const SurfaceVertex& vertex, const LobeSplit&, int, LightLayers& layers) {
      layers.add(PathClass::indirect, vertex.state.beta * Spectrum(2 * level), false);
    };
  }

 private:
  std::size_t views_before_ = 0;
};

TechniqueInfo flood() {
  return {
      .description = {.name = "flood",
                      .title = "Flood",
                      .summary = "the same light everywhere",
                      .paper = "a test",
                      .parameters = {{.info = {"flood", "3", "radiance of all pixels"},
                                      .viewer_default = "2",
                                      .numbers = NumberRange{0, 10},
                                      .control = PanelControl{.label = "Flood", .high = 10}}},
                      .has_photons = true},
      .make = [](const TechniqueShaders&) -> std::unique_ptr<Technique> { return std::make_unique<Flood>(); },
      .plan = [](const FrameSettings& s) { return FramePlan{.eye_paths_find_indirect = true, .photons = s.photons}; },
      .limitations = [](const Scene&, const GpuScene*) -> std::vector<std::string> { return {"all is flooded"}; }};
}

// Registered once per process, whichever tests run.
const bool added = [] {
  add_technique(flood());
  add_realtime_methods();
  return true;
}();

class OwnTechnique : public test::OpenGl {};

// A wall whose left half is a mirror that shows a wall behind the eye.
constexpr const char* walls = R"(
LookAt 0 0 -2  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [16] "integer yresolution" [12]
WorldBegin
LightSource "point" "rgb I" [1 1 1] "point3 from" [0 0 -3]
Material "diffuse"
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [0 -9 0  9 -9 0  9 9 0  0 9 0]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-9 -9 -9  9 -9 -9  9 9 -9  -9 9 -9]
Material "conductor" "rgb reflectance" [1 1 1] "float roughness" [0]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-9 -9 0  0 -9 0  0 9 0  -9 9 0]
)";

TEST_F(OwnTechnique, DrawsItsLightIntoTheFrame) {
  ASSERT_TRUE(added);
  const Scene scene = test::scene_from_text(walls);
  Renderer renderer(scene);
  FrameSettings settings(TechniqueChoice("flood", {{"flood", "0.5"}}));
  settings.photons = 7;
  const auto layer = [&](const char* name) { return *select_layer(renderer.read_layers(), name); };
  renderer.draw(make_view(scene.description().view), settings);
  const Image indirect = layer("indirect");
  EXPECT_FLOAT_EQ(indirect.at(12, 6, 0), 0.5f);
  EXPECT_NEAR(indirect.at(3, 6, 0), 0.5f + 2 * 0.5f, 0.01f) << "and in the mirror what eye paths find";
  EXPECT_GT(layer("direct").at(12, 6, 0), 0);
  EXPECT_EQ(renderer.report().photons_per_bounce, (std::vector<std::uint64_t>{1, 7}));
  settings.technique = TechniqueChoice("direct");
  renderer.draw(make_view(scene.description().view), settings);
  EXPECT_EQ(layer("indirect").at(12, 6, 0), 0);
}

TEST_F(OwnTechnique, IsAMethodOfTheViewer) {
  const SharedScene scene = build_scene(read_pbrt_string(walls, ".", "walls.pbrt"));
  ViewerOptions options;
  options.method = "flood";
  options.frames = 2;
  const ViewDescription& view = description_of(*scene).view;
  EXPECT_FLOAT_EQ(render_frames(scene, view, options).image.at(12, 6, 9), 2) << "the viewer's default";
  options.render.set["flood"] = "0.25";
  const ViewerFrames frames = render_frames(scene, view, options);
  EXPECT_FLOAT_EQ(frames.image.at(12, 6, 9), 0.25f);
  EXPECT_EQ(frames.report.limitations, std::vector<std::string>{"all is flooded"});
}

TEST_F(OwnTechnique, IsAMethodOfRender) {
  const Scene scene = test::scene_from_text(walls);
  RenderOptions options = test::options_for("flood", 2);
  EXPECT_NEAR(select_layer(test::render_image(scene, options), "indirect")->at(12, 6, 0), 3, 1e-5) << "the default";
  EXPECT_NEAR(select_layer(test::render_image(scene, options), "indirect")->at(3, 6, 0), 3 + 2 * 3, 0.1) << "mirror";
  options.max_depth = 1;
  EXPECT_NEAR(select_layer(test::render_image(scene, options), "indirect")->at(3, 6, 0), 3, 1e-5) << "its depth counts";
  options.set["flood"] = "1.5";
  EXPECT_NEAR(select_layer(test::render_image(scene, options), "indirect")->at(12, 6, 0), 1.5, 1e-5);
}

TEST(OwnTechniqueInfo, HasItsParametersEverywhere) {
  ASSERT_TRUE(added);
  const std::vector<MethodInfo> shown = realtime_methods();
  ASSERT_EQ(shown.back().name, "flood");
  const auto names = [](const MethodInfo& method) {
    std::vector<std::string> list;
    for (const ParameterInfo& p : method.parameters) list.push_back(p.name + '=' + p.default_value);
    return list;
  };
  EXPECT_EQ(names(shown.back()), (std::vector<std::string>{"flood=2", "shadows=maps", "map=256", "sky=4"}));
  EXPECT_EQ(names(find_method("flood")), (std::vector<std::string>{"flood=3", "shadows=traced", "map=256", "sky=4"}));
  ShownPicture picture;
  picture.scene = "a.pbrt";
  picture.method = "flood";
  picture.settings.values["flood"] = "4";
  const RenderOptions offline = offline_render(picture, {}).options;
  EXPECT_EQ(offline.integrator, "flood");
  EXPECT_EQ(offline.photons, 20000u);
  EXPECT_EQ(offline.set, (ParameterValues{{"flood", "4"}, {"shadows", "maps"}}));
}

TEST(OwnTechniqueInfo, ErrorsKnowItsParametersAndNames) {
  ASSERT_TRUE(added);
  const auto error_of = [](const ParameterValues& set) {
    return test::error_text([&] { TechniqueChoice("flood", set); });
  };
  EXPECT_EQ(error_of({{"flood", "11"}}), "--set flood=11: expected a number from 0 to 10");
  EXPECT_EQ(error_of({{"shadows", "tracd"}}),
            "--set shadows=tracd: expected none, maps or traced; did you mean traced?");
  EXPECT_EQ(error_of({{"radius", "1"}}), "--set radius=1: 'flood' has no such parameter");
  EXPECT_EQ(test::error_text([] { add_technique(flood()); }), "a technique named 'flood' exists already");
  EXPECT_EQ(test::error_text([] { TechniqueChoice("flod"); }), "there is no technique named 'flod'");
}

}  // namespace
}  // namespace lanthorn::own_technique_test
