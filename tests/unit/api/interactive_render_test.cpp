// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The interactive render with only the public headers, without a window or a server.
#include "lanthorn/interactive_render.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <variant>

#include "lanthorn/denoise.h"
#include "lanthorn/error.h"
#include "lanthorn/session.h"
#include "lanthorn/state.h"
#include "support/open_box.h"

namespace lanthorn::interactive_render_test {

namespace {

using namespace std::chrono_literals;
using enum InteractivePhase;
using Clock = std::chrono::steady_clock;

SharedScene box() {
  static const SharedScene scene = build_scene(read_scene(LANTHORN_SOURCE_DIR "/scenes/cornell-caustics.pbrt"));
  return scene;
}

ViewDescription view_of_angle(float degrees) {
  ViewDescription view = description_of(*box()).view;
  std::get<description::PerspectiveCamera>(view.camera.node).fov = degrees;
  return view;
}

RenderOptions small(std::uint64_t passes = 3) {
  RenderOptions options;
  options.integrator = "path";
  options.passes = passes;
  options.resolution = {24, 16};
  return options;
}

SharedScene darker(float factor) {
  SceneDescription description = description_of(*box());
  scale_light(description.area_lights[0], factor);
  description.hash = static_cast<std::uint64_t>(1000 * factor);
  return build_scene(std::move(description), box());
}

Image picture_of(const SharedScene& scene, const ViewDescription& view, const RenderOptions& options) {
  Session session(scene, view, options);
  session.render();
  return with_noise(session.state(), session.picture());
}
std::vector<float> pixels_of(const SharedScene& scene, const ViewDescription& view, const RenderOptions& options) {
  return picture_of(scene, view, options).pixels;
}

// The first snapshot for which `is_right` returns true. Throws Error if there is none within a minute.
template <class Condition>
InteractiveSnapshot await(const InteractiveRender& render, Condition is_right) {
  const Clock::time_point deadline = Clock::now() + 60s;
  InteractiveSnapshot now = render.snapshot();
  while (!is_right(now)) {
    if (Clock::now() > deadline)
      throw Error("not within a minute; phase " + std::to_string(static_cast<int>(now.status.phase)) + " of revision " +
                  std::to_string(now.status.revision));
    now = render.wait(now.number, 1s);
  }
  return now;
}
InteractiveSnapshot await(const InteractiveRender& render, InteractivePhase phase) {
  return await(render, [&](const InteractiveSnapshot& now) { return now.status.phase == phase; });
}

// A pass that takes hours.
RenderOptions endless_pass() {
  RenderOptions options = small();
  options.integrator = "light";
  options.photons = 4'000'000'000;
  return options;
}

TEST(InteractiveRender, ItsPictureIsThatOfASession) {
  const InteractiveRender render(box(), view_of_angle(40), small());
  const InteractiveSnapshot end = await(render, finished);
  EXPECT_FALSE(end.picture->is_coarse);
  EXPECT_EQ(end.picture->state.pass_count, 3u);
  EXPECT_EQ(end.picture->revision, end.status.revision);
  EXPECT_EQ(end.picture->image.pixels, pixels_of(box(), view_of_angle(40), small()));
  EXPECT_EQ(end.picture->seconds_left, 0);
}

TEST(InteractiveRender, TellsTheTimeLeftWhereSomethingEndsTheRender) {
  const auto is_full = [](const InteractiveSnapshot& now) {
    return now.picture && !now.picture->is_coarse && now.picture->revision == now.status.revision;
  };
  InteractiveRender render(box(), view_of_angle(40), small(1'000'000));
  EXPECT_GT(await(render, is_full).picture->seconds_left.value_or(0), 0);
  render.edit({.options = small(0xffffffff)});
  EXPECT_FALSE(await(render, is_full).picture->seconds_left);
}

TEST(InteractiveRender, TellsWhatTheMethodHasFound) {
  RenderOptions options = small(1);
  options.integrator = "auto";
  std::string remark;
  Observer observer;
  observer.remark = [&](const std::string& text) { remark = text; };
  Session(box(), view_of_angle(40), options).render(observer);
  EXPECT_NE(remark, "");
  const InteractiveRender render(box(), view_of_angle(40), options);
  EXPECT_EQ(await(render, finished).picture->remark, remark);
}

TEST(InteractiveRender, EachPartCanBeEdited) {
  InteractiveRender render(box(), view_of_angle(40), small());
  render.edit({.view = view_of_angle(30)});
  EXPECT_EQ(await(render, finished).picture->image.pixels, pixels_of(box(), view_of_angle(30), small()));
  render.edit({.scene = [] { return darker(0.5f); }});
  EXPECT_EQ(await(render, finished).picture->image.pixels, pixels_of(darker(0.5f), view_of_angle(30), small()));
  RenderOptions other = small(2);
  other.integrator = "probppm";
  other.resolution = {20, 30};
  render.edit({.options = other});
  const InteractiveSnapshot end = await(render, finished);
  EXPECT_EQ(end.picture->full_size, (std::array<int, 2>{20, 30}));
  EXPECT_EQ(end.picture->state.integrator, "probppm");
  EXPECT_EQ(end.picture->image.pixels, pixels_of(darker(0.5f), view_of_angle(30), other));
}

// The pilot of auto, and the pilot of vcm's photons, take longer than a coarse pass. vcm has a parameter of the same
// name as the file's, but rejects its value.
TEST(InteractiveRender, CoarsePicturesOfAutoHaveNoPilot) {
  const SharedScene scene = build_scene(read_pbrt_string(
      R"(Integrator "sppm" "string volume" "short-photon-beam"
)" + test::camera +
          test::box,
      ".", "test scene"));
  RenderOptions options = small(2);
  options.integrator.reset();
  InteractiveRender render(scene, description_of(*scene).view, options);
  const std::uint64_t revision = render.edit({.view = description_of(*scene).view, .is_moving = true});
  const InteractiveSnapshot coarse = await(render, [&](const InteractiveSnapshot& now) {
    return now.status.phase == failed || (now.picture && now.picture->revision == revision);
  });
  ASSERT_EQ(coarse.status.problem, "");
  EXPECT_TRUE(coarse.picture->is_coarse);
  const RenderIdentity& identity = coarse.picture->state.record.identity;
  EXPECT_EQ(identity.integrator, "vcm");
  EXPECT_EQ(identity.parameters.at("emission"), "power");
  EXPECT_EQ(coarse.picture->state.integrator, "auto");
  EXPECT_EQ(coarse.picture->remark, "");
  EXPECT_FALSE(coarse.picture->seconds_left);
  const InteractiveSnapshot end = await(render, finished);
  EXPECT_EQ(end.picture->state.integrator, "auto");
  EXPECT_EQ(end.picture->image.pixels, pixels_of(scene, description_of(*scene).view, options));
}

// Making the last picture takes milliseconds, during which the previous one must not be called finished.
TEST(InteractiveRender, FinishedPicturesHaveAllPasses) {
  RenderOptions options = small(2);
  options.resolution = {300, 200};
  InteractiveRender render(box(), view_of_angle(40), options);
  for (int i = 0; i < 5; ++i) {
    render.edit({.view = view_of_angle(41 + static_cast<float>(i))});
    InteractiveSnapshot now = render.snapshot();
    for (const auto deadline = Clock::now() + 60s; now.status.phase != finished && Clock::now() < deadline;
         now = render.snapshot())
      std::this_thread::sleep_for(100us);
    ASSERT_TRUE(now.picture);
    EXPECT_FALSE(now.picture->is_coarse);
    EXPECT_EQ(now.picture->state.pass_count, 2u);
  }
}

TEST(InteractiveRender, TheLatestOfManyEditsWins) {
  InteractiveRender render(box(), view_of_angle(40), small());
  std::mutex mutex;
  std::uint64_t latest = 0;
  float angle = 0;
  std::vector<std::thread> hands;
  for (int hand = 0; hand < 4; ++hand)
    hands.emplace_back([&, hand] {
      for (int i = 0; i < 50; ++i) {
        const float wanted = 20 + static_cast<float>(10 * hand) + 0.1f * static_cast<float>(i);
        const std::uint64_t revision = render.edit({.view = view_of_angle(wanted), .is_moving = i % 3 == 0});
        const std::lock_guard lock(mutex);
        if (revision > latest) {
          latest = revision;
          angle = wanted;
        }
      }
    });
  for (std::thread& hand : hands) hand.join();
  const InteractiveSnapshot end = await(render, finished);
  EXPECT_EQ(end.status.revision, latest);
  EXPECT_EQ(latest, 201u);
  EXPECT_EQ(end.picture->image.pixels, pixels_of(box(), view_of_angle(angle), small()));
}

// An edit that arrives while the thread checks for edits.
TEST(InteractiveRender, NoEditIsMissed) {
  InteractiveRender render(box(), view_of_angle(40), small(1), {.coarse_first = false});
  for (int i = 0; i < 60; ++i) {
    const std::uint64_t revision = render.edit({.view = view_of_angle(40 + static_cast<float>(i % 7))});
    const auto is_done = [&](const InteractiveSnapshot& now) {
      return now.status.phase == finished && now.picture->revision == revision;
    };
    ASSERT_TRUE(is_done(await(render, is_done))) << i;
  }
}

TEST(InteractiveRender, AnEditGivesUpTheRunningPass) {
  InteractiveRender render(box(), view_of_angle(40), endless_pass(), {.coarse_first = false});
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(render.snapshot().status.phase, preparing);
  render.edit({.options = small()});
  EXPECT_EQ(await(render, finished).picture->image.pixels, pixels_of(box(), view_of_angle(40), small()));
}

TEST(InteractiveRender, StopGivesUpTheRunningPass) {
  for (const bool coarse_first : {false, true}) {
    InteractiveRender render(box(), view_of_angle(40), endless_pass(), {.coarse_first = coarse_first});
    std::this_thread::sleep_for(20ms);
    const Clock::time_point start = Clock::now();
    render.stop();
    EXPECT_LT(Clock::now() - start, 10s);
    EXPECT_EQ(render.state(), nullptr);
  }
}

TEST(InteractiveRender, AnErrorIsKeptAndThePictureStays) {
  InteractiveRender render(box(), view_of_angle(40), small());
  const auto before = await(render, finished).picture;
  const std::uint64_t broken = render.edit({.scene = []() -> SharedScene { throw Error("no such room"); }});
  InteractiveSnapshot now = await(render, failed);
  EXPECT_EQ(now.status.revision, broken);
  EXPECT_EQ(now.status.problem, "no such room");
  EXPECT_EQ(now.picture, before);
  render.edit({.view = view_of_angle(30)});  // the scene is still invalid
  now = await(render, failed);
  EXPECT_EQ(now.status.revision, broken + 1);
  EXPECT_EQ(now.picture, before);
  render.edit({.scene = box});
  now = await(render, finished);
  EXPECT_EQ(now.status.problem, "");
  EXPECT_EQ(now.picture->image.pixels, pixels_of(box(), view_of_angle(30), small()));
}

TEST(InteractiveRender, OptionsThatDoNotFitAreAnError) {
  RenderOptions unknown = small(), large = small(), wide = small();
  unknown.integrator = "moonlight";
  large.memory = 1000;
  wide.memory = 64 << 20;  // enough for a coarse picture
  wide.resolution = {8000, 8000};
  EXPECT_THROW(InteractiveRender(box(), view_of_angle(40), unknown), Error);
  InteractiveRender render(box(), view_of_angle(40), small());
  for (const RenderOptions& wrong : {unknown, large, wide}) {
    const auto before = await(render, finished).picture;
    render.edit({.options = wrong});
    const InteractiveSnapshot now = await(render, failed);
    EXPECT_NE(now.status.problem.find(wrong.memory ? "memory" : "moonlight"), std::string::npos) << now.status.problem;
    EXPECT_EQ(now.picture, before);
    render.edit({.options = small()});
  }
  EXPECT_EQ(await(render, finished).picture->image.pixels, pixels_of(box(), view_of_angle(40), small()));
}

TEST(InteractiveRender, AFunctionWithoutASceneIsAnError) {
  InteractiveRender render(box(), view_of_angle(40), small());
  render.edit({.scene = [] { return SharedScene(); }});
  EXPECT_FALSE(await(render, failed).status.problem.empty());
}

TEST(InteractiveRender, CoarsePicturesComeFirstAndAloneWhileHandsMove) {
  RenderOptions options = small(1);
  options.resolution = {300, 200};
  InteractiveRender render(box(), view_of_angle(40), options);
  const auto first = await(render, [](const InteractiveSnapshot& now) { return now.picture != nullptr; }).picture;
  EXPECT_TRUE(first->is_coarse);
  EXPECT_LT(first->image.width, 200);
  EXPECT_EQ(first->full_size, (std::array<int, 2>{300, 200}));
  await(render, finished);
  const Clock::time_point start = Clock::now();
  const std::uint64_t revision = render.edit({.view = view_of_angle(30), .is_moving = true});
  const auto moved = await(render, [&](const InteractiveSnapshot& now) { return now.picture->revision == revision; });
  EXPECT_TRUE(moved.picture->is_coarse);
  const auto end = await(render, finished);
  EXPECT_GE(Clock::now() - start, 290ms) << "hands may still have moved";
  EXPECT_FALSE(end.picture->is_coarse);
  EXPECT_EQ(end.picture->image.width, 300);
}

// A pass takes a few milliseconds, and the camera has .3 s to move on. On a busy machine, an attempt may be too late.
TEST(InteractiveRender, FullPassesWaitForHands) {
  InteractiveRender render(box(), view_of_angle(40), small(1));
  bool has_looked = false;
  for (int i = 0; i < 20 && !has_looked; ++i) {
    const Clock::time_point start = Clock::now();
    const std::uint64_t revision = render.edit({.view = view_of_angle(30 + static_cast<float>(i)), .is_moving = true});
    await(render, [&](const InteractiveSnapshot& now) { return now.picture && now.picture->revision == revision; });
    std::this_thread::sleep_for(150ms);
    const bool is_coarse = render.snapshot().picture->is_coarse;
    if (Clock::now() - start > 290ms) continue;
    EXPECT_TRUE(is_coarse);
    has_looked = true;
  }
  if (!has_looked) GTEST_SKIP() << "SKIPPED, NOT TESTED: the machine is too busy";
}

TEST(InteractiveRender, WithoutCoarsePicturesAllAreWhole) {
  InteractiveRender render(box(), view_of_angle(40), small(), {.coarse_first = false});
  render.edit({.view = view_of_angle(30)});
  for (InteractiveSnapshot now = render.snapshot(); now.status.phase != finished; now = render.wait(now.number, 60s)) {
    if (!now.picture) continue;
    EXPECT_FALSE(now.picture->is_coarse);
    EXPECT_EQ(now.picture->image.width, 24);
  }
}

TEST(InteractiveRender, PausesAndGoesOn) {
  InteractiveRender render(box(), view_of_angle(40), small(4'000'000'000));
  await(render, refining);
  render.pause(true);
  std::this_thread::sleep_for(300ms);  // the end of the current pass
  const InteractiveSnapshot resting = render.snapshot();
  EXPECT_EQ(resting.status.phase, paused);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(render.snapshot().number, resting.number);
  EXPECT_EQ(render.snapshot().picture, resting.picture);
  render.pause(false);
  await(render, [&](const InteractiveSnapshot& now) {
    return now.status.phase == refining && now.picture->state.pass_count > resting.picture->state.pass_count;
  });
}

TEST(InteractiveRender, SaysThatTheTimeIsOver) {
  RenderOptions options = small(4'000'000'000);
  options.seconds = 0.1;
  const InteractiveRender render(box(), view_of_angle(40), options);
  const auto end = await(render, out_of_time);
  EXPECT_GE(end.picture->state.seconds, 0.1);
  EXPECT_GE(end.picture->state.pass_count, 1u);
}

TEST(InteractiveRender, SumsCanBeSavedAfterStop) {
  InteractiveRender render(box(), view_of_angle(40), small(4'000'000'000), {.keeps_sums = true});
  await(render, [](const InteractiveSnapshot& now) {
    return now.status.phase == refining && now.picture->state.pass_count > 3;
  });
  EXPECT_EQ(render.state(), nullptr) << "a pass is running";
  render.stop();
  ASSERT_NE(render.state(), nullptr);
  const StateSummary sums = summarize(*render.state());
  EXPECT_GT(sums.pass_count, 3u);
  EXPECT_EQ(with_noise(*render.state(), lanthorn::picture_of(*render.state())).pixels,
            pixels_of(box(), view_of_angle(40), small(sums.pass_count)));
  render.edit({.view = view_of_angle(30)});
  EXPECT_EQ(render.state(), nullptr) << "not of the last edit";
}

TEST(InteractiveRender, DenoisesThePictureOfTheEnd) {
  InteractiveRender render(box(), view_of_angle(40), small(), {.denoises = true});
  const auto is_denoised = [](const InteractiveSnapshot& now) { return now.denoised && !now.denoised->is_preview; };
  const InteractiveSnapshot end = await(render, is_denoised);
  EXPECT_EQ(end.status.phase, finished);
  EXPECT_EQ(end.denoised->passes, 3u);
  const Image clean = with_denoised_light(denoise(picture_of(box(), view_of_angle(40), small())).picture);
  EXPECT_EQ(end.denoised->image.channels, clean.channels);
  EXPECT_EQ(end.denoised->image.pixels, clean.pixels);
  EXPECT_EQ(end.picture->image.pixels, pixels_of(box(), view_of_angle(40), small())) << "the noisy picture stays";
}

TEST(InteractiveRender, PreviewsOfPicturesWithoutNoiseKeepUpWithThePasses) {
  InteractiveRender render(box(), view_of_angle(40), small(4'000'000'000), {.denoises = true});
  const InteractiveSnapshot first =
      await(render, [](const InteractiveSnapshot& now) { return now.denoised != nullptr; });
  EXPECT_TRUE(first.denoised->is_preview);
  EXPECT_LE(first.denoised->passes, first.picture->state.pass_count);
  EXPECT_EQ(first.denoised->image.pixels,
            preview_without_noise(picture_of(box(), view_of_angle(40), small(first.denoised->passes))).pixels);
}

// For passes that take longer than the interval between pictures.
TEST(InteractiveRender, EachPreviewHasHalfAsManyPassesMore) {
  RenderOptions options = small(4'000'000'000);
  options.resolution = {150, 100};
  InteractiveRender render(box(), view_of_angle(40), options, {.coarse_first = false, .denoises = true});
  std::shared_ptr<const InteractiveDenoised> last;
  for (int i = 0; i < 4; ++i) {
    const auto next =
        await(render, [&](const InteractiveSnapshot& now) { return now.denoised && now.denoised != last; }).denoised;
    if (last) {
      EXPECT_GE(2 * next->passes, 3 * last->passes);
    }
    last = next;
  }
}

TEST(InteractiveRender, DenoisingCanBeTurnedOnAndOffAtTheEnd) {
  InteractiveRender render(box(), view_of_angle(40), small());
  EXPECT_FALSE(await(render, finished).denoised);
  const auto is_denoised = [](const InteractiveSnapshot& now) { return now.denoised && !now.denoised->is_preview; };
  render.denoise(true);
  const InteractiveSnapshot on = await(render, is_denoised);
  render.denoise(false);
  const InteractiveSnapshot off = render.snapshot();
  EXPECT_FALSE(off.denoised);
  EXPECT_GT(off.number, on.number);
  EXPECT_EQ(off.picture, on.picture);
}

TEST(InteractiveRender, APictureOfASinglePassStaysAsItIs) {
  InteractiveRender render(box(), view_of_angle(40), small(1), {.denoises = true});
  EXPECT_EQ(await(render, finished).status.problem, "");
  std::this_thread::sleep_for(50ms);
  EXPECT_FALSE(render.snapshot().denoised);
  EXPECT_EQ(render.snapshot().status.phase, finished);
}

// Full quality takes ten times as long as a preview.
TEST(InteractiveRender, AnEditGivesUpWhatIsBeingDenoised) {
  RenderOptions options = small(2);
  options.resolution = {800, 600};
  InteractiveRender render(box(), view_of_angle(40), options, {.coarse_first = false, .denoises = true});
  const InteractiveSnapshot end =
      await(render, [](const InteractiveSnapshot& now) { return now.status.phase == finished && now.denoised; });
  ASSERT_TRUE(end.denoised->is_preview);
  const Clock::time_point start = Clock::now();
  EXPECT_EQ(preview_without_noise(end.picture->image).pixels, end.denoised->image.pixels);
  const Clock::duration preview_time = Clock::now() - start;
  ASSERT_TRUE(render.snapshot().denoised->is_preview) << "full quality came too soon for this test";
  const Clock::time_point edited = Clock::now();
  render.edit({.options = small(1)});
  const InteractiveSnapshot next = await(render, finished);
  EXPECT_LT(Clock::now() - edited, 2 * preview_time);
  EXPECT_FALSE(next.denoised) << "of another picture";
}

}  // namespace

}  // namespace lanthorn::interactive_render_test
