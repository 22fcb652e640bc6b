// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/stand_in.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "lanthorn/error.h"
#include "lanthorn/threads.h"
#include "path/eye_pass.h"
#include "render/picture.h"
#include "render/plan.h"
#include "support/render_scene.h"

namespace lanthorn::stand_in_test {
namespace {

constexpr int width = 160, height = 120;

// White left of the middle, half as bright right of it. In pictures of at least `slow_from` pixels, each takes
// `microseconds`.
template <int slow_from, int microseconds>
class SlowPixels final : public Integrator {
 public:
  PassReport render_pass(const RenderJob& job, std::uint32_t, const FilmPass& film,
                         const PhaseObserver& begin) override {
    begin(Phase::eye);
    const PixelWindow& window = job.view.window;
    const bool is_slow = window.width() * window.height() >= slow_from;
    PassReport report;
    report.rays = for_each_pixel(window, [&](const PixelPlace& place, RayCounts&) {
      if (is_slow) std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
      PixelSample sample;
      sample.light[0] = (2 * place.x < job.view.camera.width() ? 1.0f : 0.5f) * Rgb{1, 1, 1};
      film.add(place.index, sample);
    });
    return report;
  }
};

template <class Method>
void add_method(const char* name) {
  add_integrator({name, "sleeps", "a test", {}, [](const Parameters&) {
                    return std::unique_ptr<Integrator>(std::make_unique<Method>());
                  }});
}
const bool added = [] {
  add_method<SlowPixels<0, 100>>("slow-pixels");
  add_method<SlowPixels<width * height, 100>>("slow-whole-picture");
  add_method<SlowPixels<0, 3>>("fast-pixels");
  return true;
}();

struct Outcome {
  RenderPlan plan;
  RenderStatistics statistics;
};

class StandInTest : public testing::Test {
 protected:
  Outcome run(const char* method, StopRule stop) {
    RenderPlan plan = test::plan_render(scene_, test::options_for(method, 1));
    const RenderStatistics statistics = render(scene_, plan, stop);
    return {std::move(plan), statistics};
  }
  // Every pixel is there, at its place.
  static void expect_whole(const RenderState& state) {
    const Image color = *select_layer(picture_of(state), "color");
    ASSERT_EQ(color.width, width);
    ASSERT_EQ(color.height, height);
    for (int y = 0; y < height; ++y)
      for (const auto& [x, value] : {std::pair{0, 1.0f}, {70, 1.0f}, {90, 0.5f}, {width - 1, 0.5f}})
        ASSERT_EQ(color.pixels[static_cast<std::size_t>(3 * (y * width + x))], value) << x << ' ' << y;
  }

  const ThreadLimit limit_{1};
  const Scene scene_ = test::scene_from_text(
      R"(Film "rgb" "integer xresolution" [160] "integer yresolution" [120]
WorldBegin
LightSource "infinite")");
};

// A pass takes at least 1.9 s.
TEST_F(StandInTest, TakesThePlaceOfAPassForWhichThereIsNoTime) {
  Outcome coarse = run("slow-pixels", {.passes = {0, 100}, .seconds = 0.3});
  ASSERT_TRUE(coarse.statistics.coarse);
  EXPECT_LT(coarse.statistics.coarse->width, width);
  EXPECT_NEAR(coarse.statistics.coarse->width * 3, coarse.statistics.coarse->height * 4, 4);
  EXPECT_GT(coarse.statistics.coarse->pass_seconds, 1.9);
  EXPECT_GT(coarse.plan.state.pass_count(), 0u);
  expect_whole(coarse.plan.state);
}

TEST_F(StandInTest, TakesThePlaceOfAPassThatTakesLongerThanExpected) {
  const Outcome coarse = run("slow-whole-picture", {.passes = {0, 100}, .seconds = 0.3});
  EXPECT_TRUE(coarse.statistics.coarse);
  expect_whole(coarse.plan.state);
}

TEST_F(StandInTest, IsNotNeededIfThereIsTime) {
  const Outcome whole = run("fast-pixels", {.passes = {0, 1}, .seconds = 100});
  EXPECT_FALSE(whole.statistics.coarse);
  const Outcome unlimited = run("fast-pixels", {.passes = {0, 1}});
  EXPECT_EQ(picture_of(whole.plan.state).pixels, picture_of(unlimited.plan.state).pixels);
  EXPECT_EQ(settings_text(whole.plan.state.record), settings_text(unlimited.plan.state.record));
}

// The next call begins anew, and its state is that of a render without a stand-in.
TEST_F(StandInTest, LeavesNoTraceInTheNextCall) {
  Outcome coarse = run("slow-whole-picture", {.passes = {0, 100}, .seconds = 0.01});
  ASSERT_TRUE(coarse.statistics.coarse);
  const RenderStatistics next = render(scene_, coarse.plan, {.passes = {0, 1}});
  EXPECT_FALSE(next.coarse);
  const Outcome whole = run("slow-whole-picture", {.passes = {0, 1}});
  EXPECT_EQ(coarse.plan.state.passes, whole.plan.state.passes);
  EXPECT_EQ(picture_of(coarse.plan.state).pixels, picture_of(whole.plan.state).pixels);
  EXPECT_EQ(settings_text(coarse.plan.state.record), settings_text(whole.plan.state.record));
}

TEST_F(StandInTest, BelongsToNoOtherRender) {
  const Outcome coarse = run("slow-pixels", {.passes = {0, 100}, .seconds = 0.01});
  const Outcome whole = run("fast-pixels", {.passes = {0, 1}});
  ASSERT_TRUE(coarse.statistics.coarse);
  RenderPlan plan = test::plan_render(scene_, test::options_for("slow-pixels", 1));
  try {
    require_same_identity(coarse.plan.state, plan.state.record.identity, "a.state");
    ADD_FAILURE() << "a coarse picture was taken for a whole one";
  } catch (const Error& problem) {
    EXPECT_NE(problem.message.find("coarse"), std::string::npos) << problem.message;
  }
  EXPECT_FALSE(difference_to_replaced(coarse.plan.state, plan.state));
  EXPECT_TRUE(difference_to_replaced(coarse.plan.state, whole.plan.state));
}

// A render that is asked to stop at once in its first pass has no picture.
TEST_F(StandInTest, IsDroppedWithThePass) {
  std::atomic<bool> drop{true};
  const Outcome dropped = run("fast-pixels", {.passes = {0, 100}, .seconds = 100, .drop = &drop});
  EXPECT_FALSE(dropped.statistics.coarse);
  EXPECT_EQ(dropped.plan.state.pass_count(), 0u);
}

}  // namespace
}  // namespace lanthorn::stand_in_test
