// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Several processes that render one picture together, each with its own copy of the scene.
//
// Each process makes a `Session` of the same scene and options and calls `Session::render` with the team in its stop
// rule. The process of rank 0 deals out the passes one by one, obeys the stop rule, and has all sums at the end; its
// picture is that of one process alone, to the bit. The sessions of the others end with nothing that is of use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lanthorn {

struct TeamMessage {
  int from = 0;  ///< rank
  std::vector<std::byte> bytes;
};

/// How the processes of a team reach each other. Messages from one process to another arrive in their order. One thread
/// at a time calls these functions, not always the same one.
struct TeamLink {
  int rank = 0, size = 1;
  /// Returns at once.
  std::function<void(int to, std::vector<std::byte> bytes)> send;
  /// The next message; nothing if none has come. Also moves on what is being sent, so call it often.
  std::function<std::optional<TeamMessage>()> receive;
  /// Whether everything has left this process.
  std::function<bool()> all_sent;
};

struct Team {
  TeamLink link;
  /// Of rank 0: gather the sums at this interval, for checkpoints. None: at the end alone.
  std::optional<double> gather_seconds{};
  /// Of rank 0: also gather them at times that double from this one on, for pictures of the running render.
  std::optional<double> preview_seconds{};
  std::uint64_t rounds = 0;  ///< how often sums have been gathered, over all renders; kept by `Session::render`
};

/// For a process other than rank 0 that cannot render: tells rank 0 why, which throws this as an Error when it renders.
void report_failure(const TeamLink& link, const std::string& message);

/// Joins the processes that one MPI launcher (mpirun, srun) has started. Returns nullopt if this process is alone.
/// Loads MPI only if the launcher's environment variables show other processes. Call it once. Throws Error if MPI
/// cannot be loaded or does not find the others.
std::optional<TeamLink> join_mpi();
/// Ends the use of MPI, after all processes have come here.
void leave_mpi();
/// Ends all processes of the team at once.
[[noreturn]] void abort_mpi(int exit_code);

}  // namespace lanthorn
