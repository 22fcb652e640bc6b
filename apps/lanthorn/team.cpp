// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "team.h"

#include <unistd.h>

#include <exception>
#include <new>

#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/threads.h"
#include "signals.h"

namespace lanthorn::program {

namespace {

constexpr int bad_input = 2, internal_error = 3;

// Prints the message that `main` would print: MPI_Abort ends this process before `main` can.
int say_problem(const std::exception_ptr& problem) try { std::rethrow_exception(problem); } catch (const Error& e) {
  say("lanthorn: {}\n", e.what());
  return bad_input;
} catch (const std::bad_alloc&) {
  say("lanthorn: not enough memory in process 0\n");
  return bad_input;
} catch (const std::exception& e) {
  say("lanthorn: internal error: {}\n", e.what());
  return internal_error;
}

std::string text_of(const std::exception_ptr& problem) try {
  std::rethrow_exception(problem);
} catch (const std::bad_alloc&) {
  return "not enough memory";
} catch (const std::exception& e) {
  return e.what();
}

// Rank 0 reports the problem and ends all processes, at the latest when it has read the scene.
[[noreturn]] void wait_for_the_end(const TeamLink& link, const std::string& message) {
  report_failure(link, message);
  for (;;) ::pause();
}

void announce_team(const Team& team) {
  const auto cores = static_cast<long>(::sysconf(_SC_NPROCESSORS_ONLN));
  const bool is_bound = thread_count() == 1 && cores > team.link.size;
  say("{} processes share the passes, {} threads in this one{}\n", team.link.size, thread_count(),
      is_bound ? ": the launcher binds it to a core (mpirun --bind-to none: to all)" : "");
}

}  // namespace

void run_in_team(RenderCommand& a, const std::function<void(Team*)>& work) {
  const std::optional<TeamLink> link = join_mpi();
  if (!link) {
    handle_signals();
    return work(nullptr);
  }
  Team team{.link = *link};
  if (is_first(&team)) {
    handle_signals();
    if (!a.quiet) announce_team(team);
  } else {
    ignore_signals();
    mute();
    a.quiet = true;
  }
  try {
    work(&team);
  } catch (...) {
    if (!is_first(&team)) wait_for_the_end(team.link, text_of(std::current_exception()));
    abort_mpi(say_problem(std::current_exception()));
  }
  // The other processes do not know that there will be no more frames.
  if (is_first(&team) && stop_requested() && (a.frames || a.turntable)) abort_mpi(0);
  leave_mpi();
}

}  // namespace lanthorn::program
