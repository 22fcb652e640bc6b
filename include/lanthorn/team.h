// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Several processes that render one picture together, each with its own copy of the scene.
//
// Each process makes a `Session` of the same scene and options and calls `Session::render` with the team in its stop
// rule. The process of rank 0 assigns the passes one by one, follows the stop rule, and has all sums at the end; its
// picture equals that of a single process bit for bit. The other processes discard their sessions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lanthorn {

struct TeamMessage {
  int from = 0;  ///< rank of the sender
  std::vector<std::byte> bytes;
};

/// How the processes of a team reach each other. Messages from one process to another arrive in the order in which they
/// were sent. Only one thread at a time calls these functions, but not always the same one.
struct TeamLink {
  int rank = 0, size = 1;
  /// Starts sending a message and returns immediately.
  std::function<void(int to, std::vector<std::byte> bytes)> send;
  /// Returns the next message, or nullopt if none has arrived. Call it often: sending also progresses during this call.
  std::function<std::optional<TeamMessage>()> receive;
  /// Returns true if this process has sent all its messages.
  std::function<bool()> all_sent;
};

struct Team {
  TeamLink link;
  /// Interval at which rank 0 gathers the sums, for checkpoints. nullopt: only at the end.
  std::optional<double> gather_seconds{};
  /// Rank 0 also gathers the sums after this time and each time it has doubled, for pictures of the running render.
  std::optional<double> preview_seconds{};
  /// The number of gatherings over all renders of this team. `Session::render` counts them.
  std::uint64_t rounds = 0;
  /// Messages of the next render, from processes that have begun it already.
  std::deque<TeamMessage> early{};
};

/// Tells rank 0 why this process, of another rank, cannot render. Rank 0 throws the message as an Error from
/// `Session::render`.
void report_failure(const TeamLink& link, const std::string& message);

/// Joins the processes that one MPI launcher (mpirun, srun) has started. Returns nullopt if this process is alone.
/// Loads MPI only if the launcher's environment variables indicate other processes. Call it once. Throws Error if MPI
/// cannot be loaded or does not find the other processes.
std::optional<TeamLink> join_mpi();
/// Waits until all processes have called this function, then shuts MPI down.
void leave_mpi();
/// Ends all processes of the team immediately.
[[noreturn]] void abort_mpi(int exit_code);

}  // namespace lanthorn
