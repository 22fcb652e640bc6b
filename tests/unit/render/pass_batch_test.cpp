// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/pass_batch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "film/film_pass.h"
#include "lanthorn/threads.h"
#include "render/plan.h"
#include "support/render_scene.h"

namespace lanthorn::pass_batch_test {
namespace {

std::atomic<int> running = 0, most_running = 0, cut_short = 0;

// Passes that take a while and may overlap. Counts how many run at the same time, and how many have loops that end too
// early.
class Sleeper : public Integrator {
 public:
  bool passes_may_overlap() const override { return true; }
  PassReport render_pass(const RenderJob& /*any*/, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override {
    begin(Phase::eye);
    if (pass == failing_) throw std::runtime_error("pass 3");
    most_running = std::max(most_running.load(), ++running);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    for (std::uint32_t pixel = 0; pixel < 64; ++pixel) {
      PixelSample sample;
      sample.light[0] = static_cast<float>((pass * 7 + pixel * 13) % 11) * Rgb{1, 1, 1};
      film.add(pixel, sample);
    }
    std::atomic<int> steps = 0;
    parallel_for(0, 100, [&](int) { ++steps; });
    if (steps < 100) ++cut_short;
    --running;
    return {};
  }

 protected:
  std::uint32_t failing_ = ~0u;
};
class SleeperInTurn final : public Sleeper {
  bool passes_may_overlap() const override { return false; }
};
class FailingSleeper final : public Sleeper {
 public:
  FailingSleeper() { failing_ = 3; }
};

template <class Method>
void add_method(const char* name) {
  add_integrator({name, "sleeps", "a test", {}, [](const Parameters&) {
                    return std::unique_ptr<Integrator>(std::make_unique<Method>());
                  }});
}
const bool added = [] {
  add_method<Sleeper>("sleeper");
  add_method<SleeperInTurn>("sleeper-in-turn");
  add_method<FailingSleeper>("failing-sleeper");
  return true;
}();

struct Outcome {
  int at_once = 0;
  std::vector<std::uint64_t> looks{};  // completed passes whenever the loop reported progress
  RenderState state{};
};
Outcome run(const char* method, unsigned threads, const StopRule& rule) {
  const ThreadLimit limit(threads);
  most_running = cut_short = 0;
  const Scene scene = test::scene_from_text(
      R"(Film "rgb" "integer xresolution" [8] "integer yresolution" [8]
WorldBegin
LightSource "infinite")");
  RenderPlan plan = test::plan_render(scene, test::options_for(method, 1));
  Outcome result;
  Observer observer;
  observer.progress = [&](const RenderState& state, const auto&) { result.looks.push_back(state.pass_count()); };
  render(scene, plan, rule, observer);
  result.at_once = most_running;
  result.state = std::move(plan.state);
  return result;
}

TEST(PassBatch, ShortPassesRunAtOnceAfterTheFirst) {
  const Outcome two = run("sleeper", 2, {.passes = {0, 12}});
  EXPECT_EQ(two.state.pass_count(), 12u);
  EXPECT_EQ(two.looks.front(), 1u);
  EXPECT_LT(two.looks.size(), 6u);
  EXPECT_EQ(two.at_once, 2);
  const Outcome one = run("sleeper", 1, {.passes = {0, 12}});
  EXPECT_EQ(one.looks.size(), 12u);
  EXPECT_EQ(one.state.film.resolve(12).pixels, two.state.film.resolve(12).pixels);
}

TEST(PassBatch, PassesThatDependOnEarlierOnesRunInTurn) {
  const Outcome in_turn = run("sleeper-in-turn", 2, {.passes = {0, 6}});
  EXPECT_EQ(in_turn.at_once, 1);
  EXPECT_EQ(in_turn.looks, (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6}));
}

// The picture must not depend on how many passes run at once.
TEST(PassBatch, EndsAtEachLookAtTheError) {
  const Outcome noisy = run("sleeper", 2, {.passes = {0, 9}, .noise = 1e-9});
  for (const std::uint64_t look : {4, 5, 6, 7, 8, 9})
    EXPECT_EQ(std::count(noisy.looks.begin(), noisy.looks.end(), look), 1) << look;
}

TEST(PassBatch, LeavesOutPassesThatTheStateHas) {
  const ThreadLimit limit(2);
  const Outcome first = run("sleeper", 2, {.passes = {2, 4}});
  EXPECT_EQ(first.state.passes, (std::vector<PassRange>{{2, 4}}));
}

TEST(PassBatch, EndsWithinTheTime) {
  // Passes take 20 ms, and two run at the same time.
  const Outcome timed = run("sleeper", 2, {.passes = {0, 1000}, .seconds = 0.1});
  EXPECT_GE(timed.state.pass_count(), 2u);
  EXPECT_LE(timed.state.pass_count(), 20u);
}

TEST(PassBatch, OtherPassesComeToTheirEndIfOneFails) {
  EXPECT_THROW(run("failing-sleeper", 2, {.passes = {0, 12}}), std::runtime_error);
  EXPECT_EQ(running, 0);
  EXPECT_EQ(cut_short, 0);
}

}  // namespace
}  // namespace lanthorn::pass_batch_test
