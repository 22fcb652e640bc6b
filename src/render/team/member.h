// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A process of a team during a render.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "lanthorn/session.h"
#include "lanthorn/team.h"
#include "render/state.h"
#include "render/team/deal.h"
#include "render/team/gathering.h"
#include "render/team/message.h"

namespace lanthorn {

/// Between the pass loop and the other processes. A thread of its own talks to them while passes are rendered: it deals
/// (rank 0), and adds up and passes on sums.
class TeamMember {
 public:
  using Clock = std::chrono::steady_clock;

  /// `state`: of a render that is prepared; of rank 0 with the passes that are resumed. `start`: of the render.
  TeamMember(Team& team, const StopRule& stop, const RenderState& state, Clock::time_point start);
  ~TeamMember();
  TeamMember(const TeamMember&) = delete;
  TeamMember& operator=(const TeamMember&) = delete;

  bool is_first() const { return team_.link.rank == 0; }

  struct Pass {
    std::uint64_t number;
  };
  struct Sums {
    RoundSums sums;
  };
  struct End {};
  using Task = std::variant<Pass, Sums, End>;
  /// What the pass loop does next: a pass, at rank 0 also sums to be added (call `settle` then), or nothing more. Takes
  /// the sums of `own` when they are to be gathered, and leaves a state without passes. `rendered`: the counts of the
  /// passes since the last call. Throws what has gone wrong anywhere in the team.
  Task next(RenderState& own, const RenderStatistics& rendered);
  /// Of rank 0, after sums have been added. `enough`: the render ends with them.
  void settle(bool enough);
  /// Of rank 0: ends the render with the passes that are dealt.
  void stop();
  /// Waits until all that this process has to pass on is on its way. After the end.
  void finish();

  /// Of other ranks than 0: set when the running pass shall be given up if it leaves no trace.
  const std::atomic<bool>* give_up() const { return &give_up_; }
  /// Of other ranks than 0: set when no pass since the last round is wanted.
  const std::atomic<bool>* discard() const { return &discard_; }
  /// Of rank 0: counts of the passes that the others have rendered.
  RenderStatistics counts_of_others() const;

 private:
  void run();
  /// Returns false if there was nothing to do.
  bool step();
  void handle(const TeamMessage& received);
  void handle_at_first(int from, const Message& message);
  void add_arrived();
  void pass_on();
  void serve();
  void tell_to_wait(std::uint64_t round);
  void tell_to_give_up();
  bool is_over();
  void send(int to, const Message& message) { team_.link.send(to, encode(message)); }
  void hand_over(RenderState& own, std::uint64_t end);
  std::optional<Task> try_first(RenderState& own);
  std::optional<Task> try_other(RenderState& own);
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  Team& team_;
  StopRule stop_;
  Clock::time_point start_;
  std::atomic<bool> give_up_{false}, discard_{false};
  Gathering gathering_;  // of the thread

  mutable std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::exception_ptr problem_;
  bool is_abandoned_ = false, is_handed_over_ = false;
  std::uint64_t round_;                                       // of the pass loop
  std::deque<std::pair<std::uint64_t, RoundSums>> arriving_;  // from the pass loop
  // Of rank 0.
  std::optional<Deal> deal_;
  RenderState identity_;  // its settings alone
  std::set<int> waiting_, ended_;
  std::map<int, std::uint64_t> told_to_wait_;  // the round, by rank
  std::deque<RoundSums> gathered_;
  RenderStatistics counts_;
  bool has_told_to_give_up_ = false;
  // Of other ranks.
  std::vector<Message> questions_;  // to be sent
  std::optional<Message> answer_;   // to the question
  std::optional<std::uint64_t> last_round_;
  std::thread thread_;
};

}  // namespace lanthorn
