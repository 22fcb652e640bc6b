// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "interim_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <system_error>
#include <utility>

#include "console.h"
#include "lanthorn/error.h"
#include "output_check.h"

namespace lanthorn::program {

namespace fs = std::filesystem;

namespace {

// True if replacing the file by a later state of the same render loses nothing.
bool may_be_replaced(const fs::path& path, const RenderState& state) try {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return false;
  check_replaced_state(path, state, summarize(state).passes, "");
  return true;
} catch (const Error&) {
  return false;
}

}  // namespace

fs::path checkpoint_path(const std::vector<fs::path>& outputs) {
  return fs::path(outputs.front()).replace_extension(".state");
}

fs::path automatic_checkpoint_path(const std::vector<fs::path>& outputs, const fs::path& resumed,
                                   const RenderState& state) {
  for (int number = 1;; ++number) {
    fs::path path = outputs.front();
    path += number == 1 ? ".checkpoint.state" : fmt::format(".checkpoint-{}.state", number);
    const bool is_output =
        std::any_of(outputs.begin(), outputs.end(), [&](const fs::path& output) { return same_file(path, output); });
    if (is_output || (!resumed.empty() && same_file(path, resumed))) continue;
    if (may_be_replaced(path, state)) return path;
  }
}

Checkpoints::Checkpoints(fs::path path, double interval_seconds, bool automatic, ProgressDisplay& progress)
    : path_(std::move(path)), interval_(interval_seconds), automatic_(automatic), progress_(progress) {}

bool Checkpoints::save_if_due(const RenderState& state, double seconds_since_last) {
  if (seconds_since_last < interval_) return false;
  save(state);
  return true;
}

void Checkpoints::save(const RenderState& state) try {
  save_state(state, path_);
  saved_ = true;
} catch (const std::exception& problem) {  // the render continues: the user may free disk space
  progress_.finish();
  warn("no checkpoint: {}", problem.what());
}

void Checkpoints::finish(const RenderState& state, bool interrupted) {
  if (!saved_) return;
  std::error_code ignored;
  if (interrupted)
    save(state);
  else if (automatic_)
    fs::remove(path_, ignored);
}

Previews::Previews(std::vector<fs::path> pictures, const OutputSettings& settings, double interval,
                   const StopRule& plan, ProgressDisplay& progress)
    : pictures_(std::move(pictures)),
      settings_(settings),
      interval_(interval),
      last_pass_(plan.passes.end - plan.passes.begin),
      stops_denoised_(plan.noise && settings.denoise),
      progress_(progress) {
  std::erase_if(pictures_, [](const fs::path& path) { return path.extension() == ".state"; });
}

void Previews::write_if_due(const RenderState& state, const RenderStatistics& statistics) try {
  if (statistics.seconds < next_ || statistics.passes >= last_pass_) return;
  StatePicture picture(state, pictures_, stops_denoised_ ? RenderStatistics() : statistics);
  for (const fs::path& path : pictures_) write_preview(path, picture, settings_);
  next_ = std::max(2 * statistics.seconds, statistics.seconds + interval_);
} catch (const std::exception& problem) {  // the final write may still succeed
  next_ = std::numeric_limits<double>::infinity();
  progress_.finish();
  warn("no more previews: {}", problem.what());
}

}  // namespace lanthorn::program
