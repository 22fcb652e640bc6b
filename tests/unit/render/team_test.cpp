// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders by several processes, simulated by threads.
#include "lanthorn/team.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "render/looks.h"
#include "render/state.h"
#include "render/team/deal.h"
#include "render/team/gathering.h"
#include "render/team/message.h"
#include "support/error_text.h"

namespace lanthorn::team_test {
namespace {

using Bytes = std::vector<std::byte>;

const SharedScene& box() {
  static const SharedScene scene = build_scene(read_scene(LANTHORN_SOURCE_DIR "/scenes/cornell-caustics.pbrt"));
  return scene;
}

RenderOptions small(const std::string& integrator, std::uint64_t passes) {
  RenderOptions options;
  options.integrator = integrator;
  options.photons = 500;
  options.resolution = {12, 8};
  options.passes = passes;
  return options;
}

// Messages between threads.
class Network {
 public:
  /// `delay`: of the messages from the last process.
  explicit Network(int size, std::chrono::milliseconds delay = {})
      : delay_(delay), boxes_(static_cast<std::size_t>(size)) {}

  TeamLink link(int rank) {
    return {.rank = rank,
            .size = size(),
            .send =
                [this, rank](int to, Bytes bytes) {
                  const std::lock_guard lock(mutex_);
                  bytes_sent_ += bytes.size();
                  boxes_[static_cast<std::size_t>(to)].push_back(
                      {{rank, std::move(bytes)}, Clock::now() + (rank + 1 == size() ? delay_ : Clock::duration{})});
                },
            .receive = [this, rank]() -> std::optional<TeamMessage> {
              const std::lock_guard lock(mutex_);
              if (is_down_) throw std::runtime_error("the network is down");
              if (Clock::now() > end_) throw std::runtime_error("the team hangs");
              auto& box = boxes_[static_cast<std::size_t>(rank)];
              const auto first =
                  std::find_if(box.begin(), box.end(), [](const Sent& sent) { return sent.arrival <= Clock::now(); });
              if (first == box.end()) return std::nullopt;
              TeamMessage message = std::move(first->message);
              box.erase(first);
              return message;
            },
            .all_sent = [] { return true; }};
  }
  void go_down() {
    const std::lock_guard lock(mutex_);
    is_down_ = true;
  }
  bool is_empty() {
    const std::lock_guard lock(mutex_);
    return std::all_of(boxes_.begin(), boxes_.end(), [](const auto& box) { return box.empty(); });
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Sent {
    TeamMessage message;
    Clock::time_point arrival;
  };
  int size() const { return static_cast<int>(boxes_.size()); }

  std::chrono::milliseconds delay_;
  std::mutex mutex_;
  Clock::time_point end_ = Clock::now() + std::chrono::minutes(2);
  bool is_down_ = false;
  std::size_t bytes_sent_ = 0;
  std::vector<std::deque<Sent>> boxes_;
};

struct TeamRender {
  std::function<RenderOptions(int rank)> options;
  std::function<void(Session&)> before = [](Session&) {};  // as with --resume
  std::function<void(StopRule&)> rule = [](StopRule&) {};  // of rank 0
  Observer observer{};                                     // of rank 0
  std::optional<double> gather_seconds{};
  int rounds = 1;  // renders one after the other
  std::chrono::milliseconds delay{};
};

struct Result {
  Bytes bytes;
  StateSummary summary;
  RenderStatistics statistics;
};

Result render_as(int rank, Network& network, const TeamRender& render) {
  Team team{.link = network.link(rank), .gather_seconds = render.gather_seconds};
  Result result;
  for (int i = 0; i < render.rounds; ++i) {
    Session session(box(), render.options(rank));
    render.before(session);
    StopRule stop = session.plan();
    stop.team = &team;
    if (rank == 0) render.rule(stop);
    result.statistics = session.render(stop, rank == 0 ? render.observer : Observer{});
    result.bytes = encode_state(session.state(), {.times = false});
    result.summary = summarize(session.state());
  }
  return result;
}

// The state of rank 0 at the end.
Result run(int size, const TeamRender& render) {
  Network network(size, render.delay);
  std::vector<std::thread> others;
  for (int rank = 1; rank < size; ++rank)
    others.emplace_back([&, rank] {
      try {
        render_as(rank, network, render);
      } catch (const std::exception& problem) {
        report_failure(network.link(rank), problem.what());
      }
    });
  Result result;
  std::exception_ptr problem;
  try {
    result = render_as(0, network, render);
  } catch (...) {
    problem = std::current_exception();
    network.go_down();
  }
  for (std::thread& other : others) other.join();
  if (problem) std::rethrow_exception(problem);
  EXPECT_TRUE(network.is_empty()) << "messages that nobody has read";
  return result;
}

TeamRender of(const RenderOptions& options) {
  return {.options = [options](int) { return options; }};
}

TEST(Team, AnyNumberOfProcessesRendersTheSameBytes) {
  for (const std::string method : {"path", "probppm", "auto", "mlt"}) {
    const TeamRender render = of(small(method, 19));
    const Bytes alone = run(1, render).bytes;
    for (const int size : {2, 3, 4, 6}) {
      const Result shared = run(size, render);
      EXPECT_TRUE(shared.bytes == alone) << method << ", " << size << " processes";
      EXPECT_EQ(shared.statistics.passes, 19u);
      EXPECT_EQ(shared.statistics.passes_elsewhere, 0u);
    }
  }
}

// Counts include all processes.
TEST(Team, StatisticsCountTheRaysAndPhotonsOfAllProcesses) {
  const TeamRender render = of(small("probppm", 9));
  const RenderStatistics alone = run(1, render).statistics, shared = run(3, render).statistics;
  EXPECT_GT(alone.photons_stored, 0u);
  EXPECT_EQ(shared.light_paths, alone.light_paths);
  EXPECT_EQ(shared.photons_stored, alone.photons_stored);
  EXPECT_EQ(shared.rays.walk, alone.rays.walk);
  EXPECT_EQ(shared.rays.shadow, alone.rays.shadow);
  EXPECT_EQ(shared.rays.eye.paths, alone.rays.eye.paths);
}

TEST(Team, TheBoundOfTheErrorEndsAfterTheSamePass) {
  RenderOptions options = small("path", 200);
  options.noise = 0.35;
  const TeamRender render = of(options);
  const Result alone = run(1, render);
  ASSERT_GT(alone.summary.pass_count, 8u) << "several looks";
  ASSERT_LT(alone.summary.pass_count, 200u);
  for (const int size : {2, 3, 5}) EXPECT_TRUE(run(size, render).bytes == alone.bytes) << size;
}

TEST(Team, CheckpointsHoldThePassesFromTheFirstOn) {
  TeamRender render = of(small("path", 400));
  render.gather_seconds = 0;
  std::vector<std::uint64_t> counts;
  render.observer.checkpoint = [&](const RenderState& state, double) {
    EXPECT_EQ(state.passes.size(), 1u);
    EXPECT_EQ(state.passes.front().begin, 0u);
    counts.push_back(state.pass_count());
    return true;
  };
  EXPECT_EQ(run(3, render).summary.pass_count, 400u);
  EXPECT_GT(counts.size(), 3u);
  EXPECT_TRUE(std::is_sorted(counts.begin(), counts.end()));
}

TEST(Team, GoesOnFromAStateWithAnyNumberOfProcesses) {
  const RenderOptions options = small("auto", 24);
  const Bytes alone = run(1, of(options)).bytes;
  Session first(box(), options);
  first.render({.passes = {0, 7}});
  first.render({.passes = {9, 11}});
  TeamRender render = of(options);
  render.before = [&](Session& session) { session.resume(std::make_shared<RenderState>(first.state()), "a.state"); };
  for (const int size : {1, 2, 3}) {
    const Result resumed = run(size, render);
    EXPECT_TRUE(resumed.bytes == alone) << size;
    EXPECT_EQ(resumed.statistics.passes, 15u);
  }
}

TEST(Team, StopsInTimeWithAllPassesThatWereDealt) {
  for (const bool by_signal : {true, false}) {
    std::atomic<bool> interrupted{false};
    TeamRender render = of(small("path", 1'000'000));
    render.rule = [&](StopRule& stop) {
      stop.interrupted = &interrupted;
      if (!by_signal) stop.seconds = 0.2;
    };
    render.observer.progress = [&](const RenderState&, const RenderStatistics& s) {
      if (by_signal && s.passes >= 10) interrupted = true;
    };
    const Result shared = run(3, render);
    ASSERT_EQ(shared.summary.passes.size(), 1u);
    EXPECT_EQ(shared.summary.passes.front().begin, 0u);
    EXPECT_LT(shared.summary.pass_count, 1'000'000u);
    EXPECT_TRUE(shared.bytes == run(1, of(small("path", shared.summary.pass_count))).bytes);
  }
}

TEST(Team, APassThatIsGivenUpLeavesNoTrace) {
  std::atomic<bool> drop{false};
  TeamRender render = of(small("path", 1'000'000));
  render.rule = [&](StopRule& stop) {
    stop.drop = &drop;
    stop.undo = Undo::always;
  };
  render.observer.progress = [&](const RenderState&, const RenderStatistics& s) {
    if (s.passes >= 10) drop = true;
  };
  const Result shared = run(3, render);
  ASSERT_GE(shared.summary.pass_count, 8u);
  Session again(box(), small("path", 1));
  for (const PassRange& range : shared.summary.passes) again.render({.passes = range});
  EXPECT_TRUE(shared.bytes == encode_state(again.state(), {.times = false}));
}

TEST(Team, RendersOneAfterTheOther) {
  TeamRender render = of(small("path", 9));
  render.rounds = 3;
  render.gather_seconds = 0;
  EXPECT_TRUE(run(3, render).bytes == run(1, render).bytes);
}

// Process 1 begins the next render while rank 0 still waits for the last words of process 2.
TEST(Team, AProcessMayBeginTheNextRenderEarly) {
  TeamRender render = of(small("path", 9));
  render.rounds = 3;
  render.delay = std::chrono::milliseconds(50);
  EXPECT_TRUE(run(3, render).bytes == run(1, render).bytes);
}

TEST(Team, MethodsWhosePassesDependOnEachOtherAreRefused) {
  EXPECT_EQ(test::error_text([] { run(2, of(small("sppm", 2))); }),
            "each pass of sppm depends on all before it, so that several processes cannot share them; render it with "
            "one, or choose another --integrator");
}

TEST(Team, AProcessThatRendersSomethingElseIsNamed) {
  TeamRender render = of(small("path", 1000));
  render.options = [](int rank) {
    RenderOptions options = small("path", 1'000'000);
    options.seed = rank == 2 ? 7 : 0;
    return options;
  };
  EXPECT_EQ(test::error_text([&] { run(3, render); }),
            "process 2 of 3 renders something else: it differs in --seed (0 and 7)");
}

TEST(Team, AProcessThatFailsIsNamed) {
  TeamRender render = of(small("path", 1000));
  render.options = [](int rank) {
    if (rank == 1) throw std::runtime_error("mesh.ply: cannot be read");
    return small("path", 1'000'000);
  };
  EXPECT_EQ(test::error_text([&] { run(2, render); }), "process 1 of 2: mesh.ply: cannot be read");
}

// Deals passes until no decision is pending; returns the last answer.
Deal::Dealt deal_all(Deal& deal, std::vector<Deal::Dealt>& dealt) {
  for (;;) {
    const Deal::Dealt next = deal.next(0);
    if (next.answer != Deal::Answer::pass) return next;
    dealt.push_back(next);
  }
}

TEST(Deal, RendersOneRoundAheadOfTheLook) {
  Team team;
  team.rounds = 5;
  Deal deal({.passes = {0, 100}, .noise = 0.1}, team, {});
  std::vector<Deal::Dealt> dealt;
  const Deal::Dealt waits = deal_all(deal, dealt);
  EXPECT_EQ(waits.answer, Deal::Answer::wait);
  EXPECT_EQ(waits.round, 5u);
  ASSERT_EQ(dealt.size(), 5u) << "the first look is after four passes, the second after five";
  EXPECT_EQ(dealt[3].round, 5u);
  EXPECT_EQ(dealt[4].round, 6u);
  deal.settle(false);
  EXPECT_EQ(deal.next(0).round, 7u);
  deal.settle(true);
  EXPECT_EQ(deal.next(0).answer, Deal::Answer::end);
  EXPECT_EQ(deal.last_round(), 6u) << "pass 5, of round 7, is not wanted";
}

TEST(Deal, LeavesOutWhatIsDone) {
  Deal deal({.passes = {2, 9}}, {}, {{0, 4}, {6, 8}});
  std::vector<Deal::Dealt> dealt;
  EXPECT_EQ(deal_all(deal, dealt).answer, Deal::Answer::end);
  ASSERT_EQ(dealt.size(), 3u);
  EXPECT_EQ(dealt[0].pass, 4u);
  EXPECT_EQ(dealt[1].pass, 5u);
  EXPECT_EQ(dealt[2].pass, 8u);
}

TEST(Deal, GathersAtItsInterval) {
  Team team;
  team.gather_seconds = 10;
  Deal deal({.passes = {0, 100}}, team, {});
  EXPECT_EQ(deal.next(0).round, 0u);
  EXPECT_EQ(deal.next(9).round, 0u);
  EXPECT_EQ(deal.next(11).round, 1u);
  EXPECT_EQ(deal.next(22).round, 1u) << "the sums of round 0 are under way";
  deal.settle(false);
  EXPECT_EQ(deal.next(23).round, 2u);
}

TEST(Looks, ComeAfterAnEighthMore) {
  EXPECT_EQ(next_look(0).passes, 4u);
  EXPECT_EQ(next_look(4).passes, 5u);
  EXPECT_EQ(next_look(16).passes, 18u);
  EXPECT_TRUE(is_look(4, false));
  EXPECT_FALSE(is_look(0, false));
  EXPECT_FALSE(is_look(17, false));
}

TEST(Looks, AreTakenOneInThreeIfTheyAreCostly) {
  std::vector<std::uint64_t> taken;
  for (std::uint64_t passes = 0; passes <= 60; ++passes)
    if (is_look(passes, true)) taken.push_back(passes);
  EXPECT_EQ(taken, (std::vector<std::uint64_t>{4, 7, 10, 13, 16, 22, 30, 41, 57}));
}

TEST(Gathering, TreeReachesEveryProcessOnce) {
  for (const int size : {1, 2, 3, 7, 1000}) {
    int children = 0;
    for (int rank = 0; rank < size; ++rank) {
      children += Gathering::children(rank, size);
      if (rank > 0) {
        EXPECT_LT(Gathering::parent(rank), rank);
      }
    }
    EXPECT_EQ(children, size - 1);
  }
}

TEST(Gathering, WaitsForAllOfARound) {
  Gathering gathering(0, 3);
  gathering.add_own(0, std::nullopt);
  gathering.add_own(1, std::nullopt);
  gathering.add_child(0, {});
  EXPECT_FALSE(gathering.take_complete());
  gathering.add_child(0, {});
  const auto complete = gathering.take_complete();
  ASSERT_TRUE(complete);
  EXPECT_EQ(complete->round, 0u);
  EXPECT_FALSE(complete->sums);
  EXPECT_TRUE(complete->packed.bytes.empty());
  EXPECT_FALSE(gathering.take_complete());
  EXPECT_EQ(test::error_text([&] { gathering.add_child(0, {}); }),
            "sums of round 0 arrive after this process has passed that round on");
}

// In any order of arrival, and with processes that have rendered nothing.
TEST(Gathering, AddsTheSumsOfAllThatHaveSome) {
  std::vector<RenderState> states;
  RenderState all;
  for (std::uint64_t i = 0; i < 3; ++i) {
    Session session(box(), small("path", 1));
    session.render({.passes = {i, i + 1}});
    states.push_back(session.state());
    if (i == 0) all = session.state();
    if (i > 0) merge_into(all, session.state());
  }
  const auto without_times = [](const RenderState& state) { return encode_state(state, {.times = false}); };
  for (const bool own_first : {true, false})
    for (const bool has_own : {true, false})
      for (const bool has_second : {true, false}) {
        Gathering gathering(0, 3);
        const auto add_own = [&] { gathering.add_own(5, has_own ? RoundSums(states[0]) : RoundSums()); };
        if (own_first) add_own();
        gathering.add_child(5, {encode_state(states[1]), "the sums of process 1"});
        gathering.add_child(5, {has_second ? encode_state(states[2]) : Bytes(), "the sums of process 2"});
        if (!own_first) add_own();
        RenderState expected = states[1];
        if (has_own) merge_into(expected, states[0]);
        if (has_second) merge_into(expected, states[2]);
        auto complete = gathering.take_complete();
        ASSERT_TRUE(complete);
        auto bytes = *complete;
        EXPECT_TRUE(without_times(decode_state(bytes.take_bytes(), "bytes")) == without_times(expected));
        EXPECT_TRUE(without_times(*complete->take_sums()) == without_times(expected));
      }
}

TEST(Gathering, DamagedSumsNameTheirProcess) {
  Gathering gathering(0, 2);
  Session session(box(), small("path", 1));
  session.render({.passes = {0, 1}});
  Bytes bytes = encode_state(session.state());
  bytes[bytes.size() / 2] ^= std::byte{1};
  gathering.add_child(0, {bytes, "the sums of process 1"});
  EXPECT_NE(test::error_text([&] { gathering.add_own(0, empty_like(session.state())); }).find("the sums of process 1"),
            std::string::npos);
}

// A process that forgets a child would lose its sums; one that waits for a missing child would wait for ever.
TEST(Gathering, ATreeOnWhichProcessesDoNotAgreeIsNoticedWhenAllHaveJoined) {
  const auto said = [](std::uint64_t parent_of_third, std::uint64_t awaited_by_first) {
    return test::error_text([&] {
      TreeCheck check(4, 2);
      check.join(3, parent_of_third, 0);
      check.join(1, 0, awaited_by_first);
      check.join(2, 0, 0);
    });
  };
  EXPECT_EQ(said(1, 1), "no error");
  EXPECT_EQ(
      said(1, 0),
      "process 1 of 4 waits for the sums of 0 processes, but 1 pass theirs on to it: the processes do not run the "
      "same program");
  EXPECT_NE(said(1, 2).find("process 1 of 4 waits for the sums of 2 processes, but 1 pass"), std::string::npos);
  EXPECT_NE(said(0, 1).find("process 0 of 4 waits for the sums of 2 processes, but 3 pass"), std::string::npos);
  EXPECT_NE(said(9, 1).find("passes its sums on to process 9"), std::string::npos);
}

TEST(Team, AProcessThatExpectsAnotherTreeEndsTheRender) {
  Network network(2);
  const RenderOptions options = small("path", 1'000'000);
  Session other(box(), options);
  network.link(1).send(
      0, encode({.kind = MessageKind::join, .a = 0, .b = 1, .rest = bytes_of(settings_text(other.state().record))}));
  const TeamRender render = of(options);
  EXPECT_NE(test::error_text([&] { render_as(0, network, render); }).find("process 1 of 2 waits for the sums of 1"),
            std::string::npos);
}

}  // namespace
}  // namespace lanthorn::team_test
