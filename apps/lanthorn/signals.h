// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Signals end a command in steps, so that its work is saved. During a render, the first signal asks to finish the pass
// and save, the second to save without the running pass, the third ends the program. Each is acknowledged at once.
#pragma once

#include <atomic>

namespace lanthorn::program {

/// What a command is doing, which decides what a signal means.
enum class Stage {
  loading,    ///< nothing to save yet: a signal ends the program
  rendering,  ///< as above
  measuring,  ///< the first signal gives up the running render, the second ends the program
  serving,    ///< the same
  saving,     ///< files are written: the third signal ends the program
  waiting,    ///< files could not be written: a signal ends the waiting
};

/// From now on SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ, SIGXCPU, SIGUSR1 and SIGUSR2 are handled; the stage is
/// loading. What is ignored (SIGHUP under nohup) stays ignored. SIGPIPE and SIGXFSZ that come of the program's own
/// messages and files, and SIGXCPU, which the system repeats, count once, as a first signal.
void handle_signals();
/// These signals do nothing from now on: of processes that another one commands.
void ignore_signals();
void set_stage(Stage stage);
/// Whether the running pass can be given up, for the answer to the second signal.
void set_can_drop(bool can_drop);

/// Set by the first signal: finish the pass and save.
const std::atomic<bool>& stop_requested();
/// Set by the second (or, when measuring, by the first): give up the pass.
const std::atomic<bool>& drop_requested();
/// Set by a signal while waiting.
const std::atomic<bool>& waiting_ended();

/// Ends the program as the last signal would have without `handle_signals`.
[[noreturn]] void end_by_signal();

}  // namespace lanthorn::program
