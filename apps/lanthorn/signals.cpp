// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "signals.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <string_view>

namespace lanthorn::program {

namespace {

// The only data that the signal handler reads and writes.
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free &&
              std::atomic<Stage>::is_always_lock_free);
std::atomic<Stage> stage{Stage::loading};
std::atomic<int> level{0}, last_signal{SIGTERM};
std::atomic<bool> stop{false}, drop{false}, end_waiting{false}, can_drop{false};

// Ignores errors, as for all messages.
void answer(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno != EINTR) return;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
}

// The signal is blocked while it is handled; it ends the program when the handler returns.
void end_program(int signal, std::string_view text) {
  answer(text);
  struct sigaction standard {};
  standard.sa_handler = SIG_DFL;
  ::sigaction(signal, &standard, nullptr);
  ::raise(signal);
}

void answer_while_rendering(int signal, int request) {
  if (request == 1) {
    answer("\nlanthorn: finishing this pass, then saving (again: save without it)\n");
    stop = true;
  } else if (request == 2) {
    answer(can_drop
               ? "\nlanthorn: abandoning this pass, then saving (again: end without saving)\n"
               : "\nlanthorn: this pass cannot be abandoned: finishing it, then saving (again: end without saving)\n");
    drop = true;
  } else {
    end_program(signal, "\nlanthorn: ended without saving\n");
  }
}

void give_up_pass(int signal, int request, std::string_view text) {
  if (request > 1) return end_program(signal, "\nlanthorn: ended without saving\n");
  answer(text);
  stop = drop = true;
}

void answer_signal(int signal, int request) {
  switch (stage.load()) {
    case Stage::loading:
      return end_program(signal, "\nlanthorn: nothing is rendered yet, so nothing is saved\n");
    case Stage::rendering:
      return answer_while_rendering(signal, request);
    case Stage::measuring:
      return give_up_pass(signal, request, "\nlanthorn: ending with the complete renders (again: end without them)\n");
    case Stage::serving:
      return give_up_pass(signal, request, "\nlanthorn: ending the server\n");
    case Stage::saving:
      if (request > 2) return end_program(signal, "\nlanthorn: ended while saving\n");
      return answer("\nlanthorn: saving\n");
    case Stage::waiting:
      end_waiting = true;
      return;
  }
}

// True for a signal that the program's own writes raised, or that the system repeats as long as the program runs.
bool comes_by_itself(int signal, const siginfo_t& info) {
  if (signal == SIGXCPU) return info.si_code == SI_KERNEL;
  return (signal == SIGPIPE || signal == SIGXFSZ) && info.si_pid == ::getpid();
}

// Returns the ordinal number of this request; 0 if it does not count.
int count_request(bool by_itself) {
  if (!by_itself) return ++level;
  if (stage != Stage::rendering && stage != Stage::measuring && stage != Stage::serving) return 0;
  int none = 0;
  return level.compare_exchange_strong(none, 1) ? 1 : 0;
}

extern "C" void on_signal(int signal, siginfo_t* info, void* /*context*/) {
  const int error = errno;
  if (const int request = count_request(comes_by_itself(signal, *info))) {
    last_signal = signal;
    answer_signal(signal, request);
  }
  errno = error;
}

constexpr int handled[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ, SIGXCPU, SIGUSR1, SIGUSR2};

}  // namespace

void handle_signals() {
  struct sigaction action {};
  action.sa_sigaction = on_signal;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  ::sigfillset(&action.sa_mask);
  for (const int signal : handled) {
    struct sigaction old {};
    if (::sigaction(signal, nullptr, &old) == 0 && old.sa_handler == SIG_IGN) continue;
    ::sigaction(signal, &action, nullptr);
  }
}

void ignore_signals() {
  for (const int signal : handled) ::signal(signal, SIG_IGN);
}

void set_stage(Stage next) { stage = next; }
void set_can_drop(bool value) { can_drop = value; }
const std::atomic<bool>& stop_requested() { return stop; }
const std::atomic<bool>& drop_requested() { return drop; }
const std::atomic<bool>& waiting_ended() { return end_waiting; }

void end_by_signal() {
  end_program(last_signal, {});
  std::_Exit(128 + last_signal);
}

}  // namespace lanthorn::program
