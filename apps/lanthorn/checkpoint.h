// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// States saved while a render runs, in case the machine stops.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lanthorn/state.h"
#include "progress.h"

namespace lanthorn {

/// Renders that are to end sooner have no checkpoints unless they are asked for.
inline constexpr double automatic_checkpoint_seconds = 600;

/// Where checkpoints go that the user asked for: beside the first output, with ".state" for its extension.
std::filesystem::path checkpoint_path(const std::vector<std::filesystem::path>& outputs);

/// Where those go that nobody asked for: "a.exr.checkpoint.state" for the first output "a.exr", or that name with a
/// number if the file is an output, is `resumed`, or holds another render or passes that `state` lacks.
std::filesystem::path automatic_checkpoint_path(const std::vector<std::filesystem::path>& outputs,
                                                const std::filesystem::path& resumed, const RenderState& state);

/// Saves a state from time to time.
class Checkpoints {
 public:
  /// Automatic ones are removed when they are no longer needed.
  Checkpoints(std::filesystem::path path, double interval_seconds, bool automatic, ProgressDisplay& progress);

  const std::filesystem::path& path() const { return path_; }
  double interval() const { return interval_; }
  bool automatic() const { return automatic_; }
  /// Saves the state if the last checkpoint was so long ago; true if it is to be asked again only after another
  /// interval. A state that cannot be saved is warned of.
  bool save_if_due(const RenderState& state, double seconds_since_last);
  /// All outputs are written. `interrupted`: a signal ended the render, which may be gone on with from the last
  /// checkpoint: it is brought up to date, if there is one.
  void finish(const RenderState& state, bool interrupted);

 private:
  void save(const RenderState& state);

  std::filesystem::path path_;
  double interval_;
  bool automatic_;
  ProgressDisplay& progress_;
  bool saved_ = false;
};

}  // namespace lanthorn
