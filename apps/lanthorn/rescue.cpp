// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "rescue.h"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <thread>

#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/text.h"
#include "signals.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;

constexpr auto retry_interval = std::chrono::seconds(10);

// The user's folder for program states (XDG Base Directory Specification). nullopt if the user has no home.
std::optional<fs::path> state_folder() {
  if (const char* const folder = std::getenv("XDG_STATE_HOME"); folder && fs::path(folder).is_absolute())
    return fs::path(folder) / "lanthorn";
  const char* home = std::getenv("HOME");
  if (!home || !fs::path(home).is_absolute()) {
    const passwd* const user = ::getpwuid(::getuid());
    home = user ? user->pw_dir : nullptr;
  }
  if (!home || !fs::path(home).is_absolute()) return {};
  return fs::path(home) / ".local/state/lanthorn";
}

fs::path make_state_folder() {
  const auto folder = state_folder();
  if (!folder) throw Error("the user has no home folder");
  if (fs::create_directories(*folder)) fs::permissions(*folder, fs::perms::owner_all);
  return *folder;
}

// Returns the error message; any failure, including lack of memory, is a reason to try something else.
std::optional<std::string> problem_of(const std::function<void()>& work) try {
  work();
  return {};
} catch (const std::exception& problem) {
  return problem.what();
}

std::optional<fs::path> rescue(const RenderState& state, const fs::path& output) {
  std::optional<fs::path> saved;
  problem_of([&] {
    const std::vector<std::byte> bytes = encode_state(state);
    const std::string prefix = output.stem().string().substr(0, 200) + ".rescue-";
    const fs::path beside = output.has_parent_path() ? output.parent_path() : fs::current_path();
    const auto save_in = [&](const fs::path& folder) { saved = write_private_file(folder, prefix, ".state", bytes); };
    if (problem_of([&] { save_in(beside); })) save_in(make_state_folder());
  });
  return saved;
}

// Waits, unless a signal arrives.
bool wait_to_retry() {
  const auto end = std::chrono::steady_clock::now() + retry_interval;
  while (std::chrono::steady_clock::now() < end && !waiting_ended())
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return !waiting_ended();
}

std::string line_for(const Output& output, const std::string& problem) {
  const std::string path = output.path.string();
  return printable(problem.starts_with(path) ? problem : path + ": " + problem) + '\n';
}

std::string without_last_newline(std::string text) {
  if (text.ends_with('\n')) text.pop_back();
  return text;
}

/// Outputs that are not all written yet.
class Saving {
 public:
  Saving(const std::vector<Output>& outputs, const RenderState& state) : left_(outputs), state_(state) {}

  /// Returns true once all are written.
  bool write() {
    problems_.clear();
    std::erase_if(left_, [&](const Output& output) {
      const auto problem = problem_of(output.write);
      if (problem) {
        problems_ += line_for(output, *problem);
      } else if (output.kind == OutputKind::state) {
        saved_ = output.path;
      }
      return !problem;
    });
    return left_.empty();
  }
  bool only_reports_are_left() const {
    return std::all_of(left_.begin(), left_.end(),
                       [](const Output& output) { return output.kind == OutputKind::report; });
  }
  /// Where the state was saved after a failure.
  const std::optional<fs::path>& save_state_somewhere() {
    if (!saved_) saved_ = rescue(state_, left_.front().path);
    return saved_;
  }
  /// The errors, one line per file.
  const std::string& problems() const { return problems_; }

 private:
  std::vector<Output> left_;
  const RenderState& state_;
  std::string problems_;
  std::optional<fs::path> saved_;
};

}  // namespace

void write_all(const std::vector<Output>& outputs) {
  std::string problems;
  for (const Output& output : outputs)
    if (const auto problem = problem_of(output.write)) problems += line_for(output, *problem);
  if (!problems.empty()) throw OutputError(without_last_newline(problems));
}

void write_outputs(const std::vector<Output>& outputs, const RenderState& state) {
  Saving saving(outputs, state);
  set_stage(Stage::saving);
  for (bool waited = false; !saving.write(); waited = true) {
    if (saving.only_reports_are_left()) throw OutputError(without_last_newline(saving.problems()));
    if (const auto& saved = saving.save_state_somewhere())
      throw OutputError(fmt::format("{}The render is saved in {}: continue it with --resume", saving.problems(),
                                    printable(saved->string())));
    set_stage(Stage::waiting);
    if (!waited)
      say_text(fmt::format("lanthorn: {}The render exists only in memory; retrying every {} s (Ctrl-C discards it)\n",
                           saving.problems(), retry_interval.count()));
    if (!wait_to_retry())
      throw OutputError(saving.problems() + "The render is discarded as requested: it is not saved");
    set_stage(Stage::saving);
  }
}

}  // namespace lanthorn::program
