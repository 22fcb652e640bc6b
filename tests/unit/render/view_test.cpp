// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/view.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "lanthorn/state.h"
#include "support/error_text.h"
#include "support/open_box.h"
#include "support/render_scene.h"

namespace lanthorn::view_test {
namespace {

RenderPlan render_by(const Scene& scene, const ViewDescription& view, const RenderOptions& options) {
  RenderPlan plan = plan_render(scene, view, options);
  render(scene, plan, plan.stop);
  return plan;
}

// A scene rendered with the camera of another file gives the other file's picture.
TEST(View, IsNoPartOfTheScene) {
  const Scene scene = test::scene_from_text(test::camera + test::box);
  const Scene other = test::scene_from_text(
      R"(LookAt 0.5 1.5 3  0 0.8 0  0 1 0
Camera "perspective" "float fov" [50] "float lensradius" [0.05] "float focaldistance" [3]
Film "rgb" "integer xresolution" [20] "integer yresolution" [16]
PixelFilter "triangle"
WorldBegin
)" + test::box);
  for (const char* integrator : {"path", "light", "probppm", "sppm", "vcm", "mlt", "photonmap"}) {
    RenderOptions options = test::options_for(integrator, 2);
    options.photons = 1000;
    options.crop = {2, 1, 18, 15};
    const RenderPlan moved = render_by(scene, other.description().view, options);
    const RenderPlan own = render_by(other, other.description().view, options);
    EXPECT_EQ(moved.view.window.width(), 16);
    EXPECT_EQ(picture_of(moved.state).pixels, picture_of(own.state).pixels) << integrator;
  }
}

TEST(View, RecordedOptionsArePartOfTheIdentity) {
  const Scene scene = test::scene_from_text(test::camera + test::box);
  RenderOptions clamped;
  clamped.clamp = 2.0f;
  EXPECT_EQ(identity_difference(test::plan_render(scene, {}).state, test::plan_render(scene, clamped).state),
            "--clamp (not set and 2.0)");
}

TEST(View, RefusesAClampThatIsNoNumber) {
  const Scene scene = test::scene_from_text(test::camera + test::box);
  for (const float clamp : {0.0f, -1.0f, std::numeric_limits<float>::infinity()}) {
    RenderOptions options;
    options.clamp = clamp;
    EXPECT_THROW(test::plan_render(scene, options), Error) << clamp;
  }
}

// Passes of two views must not be added up. The file's own view is identified by the file's hash.
TEST(View, IsPartOfWhatAStateBelongsTo) {
  const Scene scene = test::scene_from_text(test::camera + test::box);
  const ViewDescription own = scene.description().view;
  const auto difference = [&](auto change) {
    ViewDescription changed = own;
    change(changed);
    const RenderPlan a = plan_render(scene, own, {}), b = plan_render(scene, changed, {});
    return identity_difference(a.state, b.state).value_or("none");
  };
  EXPECT_EQ(difference([](ViewDescription&) {}), "none");
  EXPECT_FALSE(plan_render(scene, own, {}).state.record.identity.view);
  EXPECT_EQ(difference([](ViewDescription& v) {
              std::get<description::PerspectiveCamera>(v.camera.node).fov += 1;
            }).substr(0, 14),
            "view (not set ");
  EXPECT_NE(difference([](ViewDescription& v) { v.camera.camera_to_world.end.matrix[3][1] += 0.5f; }), "none");
  EXPECT_NE(difference([](ViewDescription& v) { v.film.white_balance = 4000; }), "none");
}

TEST(View, ErrorsSayWhatWasExpected) {
  const SceneDescription description = read_pbrt_string(test::camera, ".", "t.pbrt");
  const auto error_of = [&](const ViewOptions& options) {
    return test::error_text([&] { make_view(description.view, options); });
  };
  EXPECT_EQ(error_of({}), "no error");
  EXPECT_NE(error_of({{{0, 4}}, {}}).find("--resolution 0x4: expected WIDTHxHEIGHT"), std::string::npos);
  EXPECT_NE(error_of({{}, {{0, 0, 25, 4}}}).find("--crop 0,0,25,4: expected x0,y0,x1,y1"), std::string::npos);
  EXPECT_EQ(error_of({{{100, 100}}, {{0, 0, 25, 4}}}), "no error");
}

}  // namespace
}  // namespace lanthorn::view_test
