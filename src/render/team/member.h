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

/// Connects the pass loop with the other processes. It has a thread that sends and receives messages while passes are
/// rendered. This thread deals out passes (at rank 0), adds up sums and passes them on.
class TeamMember {
 public:
  using Clock = std::chrono::steady_clock;

  /// `state`: the state of a prepared render; at rank 0 it has the passes that are resumed. `start`: the time at which
  /// the render began.
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
  /// Waits for the pass loop's next task. The loop renders a Pass, adds Sums (at rank 0 alone) and then calls `settle`,
  /// or stops at the End. When the sums of `own` are to be gathered, this function takes them and leaves a state
  /// without passes. `rendered`: the counts of the passes since the last call. Throws Error if a process of the team
  /// has failed.
  Task next(RenderState& own, const RenderStatistics& rendered);
  /// Rank 0 calls this function after it has added sums. `enough`: the render ends with these sums.
  void settle(bool enough);
  /// Rank 0 calls this function to end the render with the passes that are dealt.
  void stop();
  /// Waits until this process has passed on all its sums. The pass loop calls this function after the End.
  void finish();

  /// At ranks other than 0, this flag is set when the running pass is to be given up, provided that it can be undone.
  const std::atomic<bool>* give_up() const { return &give_up_; }
  /// At ranks other than 0, this flag is set when the passes since the last round are no longer needed.
  const std::atomic<bool>* discard() const { return &discard_; }
  /// Returns, at rank 0, the counts of the passes that the other processes have rendered.
  RenderStatistics counts_of_others() const;

 private:
  void run();
  /// Returns false if there was nothing to do.
  bool step();
  std::optional<TeamMessage> receive();
  void handle(const TeamMessage& received);
  void handle_at_first(int from, const Message& message);
  void add_arrived();
  void pass_on();
  void serve();
  void tell_to_wait(std::uint64_t round);
  void tell_to_give_up();
  bool is_over();
  void send(int to, Message message) {
    message.first_round = first_round_;
    team_.link.send(to, encode(message));
  }
  void hand_over(RenderState& own, std::uint64_t end);
  std::optional<Task> try_first(RenderState& own);
  std::optional<Task> try_other(RenderState& own);
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  Team& team_;
  const std::uint64_t first_round_;
  StopRule stop_;
  Clock::time_point start_;
  std::atomic<bool> give_up_{false}, discard_{false};
  std::deque<TeamMessage> early_;  // messages that came during the render before; only the thread uses them
  Gathering gathering_;            // the same
  TreeCheck tree_check_;           // the same, at rank 0

  mutable std::mutex mutex_;  // protects all members below
  std::condition_variable changed_;
  std::exception_ptr problem_;
  bool is_abandoned_ = false, is_handed_over_ = false;
  std::uint64_t round_;                                       // the round that the pass loop renders
  std::deque<std::pair<std::uint64_t, RoundSums>> arriving_;  // the pass loop has handed these over
  // Only rank 0 uses these.
  std::optional<Deal> deal_;
  RenderIdentity identity_;
  std::set<int> waiting_, ended_;
  std::map<int, std::uint64_t> told_to_wait_;  // the last round for which each rank was told to wait
  std::deque<RoundSums> gathered_;
  RenderStatistics counts_;
  bool has_told_to_give_up_ = false;
  // Only the other ranks use these.
  std::vector<Message> questions_;  // the thread sends them
  std::optional<Message> answer_;   // rank 0 has sent it, and the pass loop has not taken it yet
  std::optional<std::uint64_t> last_round_;
  std::thread thread_;
};

}  // namespace lanthorn
