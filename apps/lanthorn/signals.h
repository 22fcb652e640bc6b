// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Signals end a command in steps, so that its work is saved. During a render, the first signal requests to finish the
// pass and save, the second to save without the current pass; the third ends the program. Each is acknowledged
// immediately with a message.
#pragma once

#include <atomic>

namespace lanthorn::program {

/// The activity of a command, which decides what a signal means.
enum class Stage {
  loading,    ///< nothing to save yet: a signal ends the program
  rendering,  ///< as described above
  measuring,  ///< the first signal abandons the current render, the second ends the program
  serving,    ///< as `measuring`
  saving,     ///< files are being written: the third signal ends the program
  waiting,    ///< files could not be written: a signal ends the waiting
};

/// Handles SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ, SIGXCPU, SIGUSR1 and SIGUSR2 from now on; the stage is `loading`.
/// Ignored signals (SIGHUP under nohup) stay ignored. SIGPIPE and SIGXFSZ that the program's own messages and files
/// cause, and SIGXCPU, which the system repeats, count only once, as a first signal.
void handle_signals();
/// Ignores these signals from now on: for processes that another one controls.
void ignore_signals();
void set_stage(Stage stage);
/// Sets whether the current pass can be abandoned, which decides the answer to the second signal.
void set_can_drop(bool can_drop);

/// Set by the first signal: finish the pass and save.
const std::atomic<bool>& stop_requested();
/// Set by the second signal (when measuring, by the first): abandon the pass.
const std::atomic<bool>& drop_requested();
/// Set by a signal while waiting.
const std::atomic<bool>& waiting_ended();

/// Ends the program as the last signal would have done without `handle_signals`.
[[noreturn]] void end_by_signal();

}  // namespace lanthorn::program
