// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Files that a render writes while it runs: previews of its pictures, and checkpoints: states from which it goes on if
// the machine stops.
#pragma once

#include <filesystem>
#include <vector>

#include "lanthorn/session.h"
#include "lanthorn/state.h"
#include "output.h"
#include "progress.h"

namespace lanthorn::program {

/// Shorter renders get no automatic checkpoints.
inline constexpr double automatic_checkpoint_seconds = 600;

/// The file for checkpoints that the user requested: the first output's name with the extension ".state".
std::filesystem::path checkpoint_path(const std::vector<std::filesystem::path>& outputs);

/// The file for automatic checkpoints: "a.exr.checkpoint.state" for the first output "a.exr". The name gets a number if
/// that file is an output, is `resumed`, or holds another render or passes that `state` lacks.
std::filesystem::path automatic_checkpoint_path(const std::vector<std::filesystem::path>& outputs,
                                                const std::filesystem::path& resumed, const RenderState& state);

/// Saves a state at regular intervals.
class Checkpoints {
 public:
  /// An automatic checkpoint is temporary: `finish` deletes it unless the render was interrupted.
  Checkpoints(std::filesystem::path path, double interval_seconds, bool automatic, ProgressDisplay& progress);

  const std::filesystem::path& path() const { return path_; }
  double interval() const { return interval_; }
  bool automatic() const { return automatic_; }
  /// Saves the state if the interval since the last checkpoint has passed; returns true if it did, so that the caller
  /// restarts its clock. Warns if the state cannot be saved.
  bool save_if_due(const RenderState& state, double seconds_since_last);
  /// Call when all outputs are written. `interrupted`: a signal ended the render, which may be resumed from the last
  /// checkpoint; if there is one, it is updated.
  void finish(const RenderState& state, bool interrupted);

 private:
  void save(const RenderState& state);

  std::filesystem::path path_;
  double interval_;
  bool automatic_;
  ProgressDisplay& progress_;
  bool saved_ = false;
};

/// Writes the pictures after the first pass, and again each time the elapsed time has doubled.
class Previews {
 public:
  /// `interval`: minimum time between two writes, seconds. `plan`: the last pass needs no preview.
  Previews(std::vector<std::filesystem::path> pictures, const OutputSettings& settings, double interval,
           const StopRule& plan, ProgressDisplay& progress);

  /// Call after every pass. Warns once if a picture cannot be written; the render continues.
  void write_if_due(const RenderState& state, const RenderStatistics& statistics);

 private:
  std::vector<std::filesystem::path> pictures_;
  const OutputSettings& settings_;
  double interval_;
  std::uint64_t last_pass_;
  bool stops_denoised_;  // the error in the statistics may be that of the denoised picture
  ProgressDisplay& progress_;
  double next_ = 0;  // seconds since the render's start
};

}  // namespace lanthorn::program
