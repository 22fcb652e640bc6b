// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The outputs, while the render runs.
#pragma once

#include <filesystem>
#include <vector>

#include "lanthorn/session.h"
#include "output.h"
#include "progress.h"

namespace lanthorn::program {

/// Writes the pictures after the first pass, and again whenever the time since the start has doubled.
class Previews {
 public:
  /// `interval`: the least time between two writings, seconds. `plan`: the last pass needs no preview.
  Previews(std::vector<std::filesystem::path> pictures, const OutputSettings& settings, double interval,
           const StopRule& plan, ProgressDisplay& progress);

  /// Call after every pass. Warns once if a picture cannot be written; the render goes on.
  void write_if_due(const RenderState& state, const RenderStatistics& statistics);

 private:
  std::vector<std::filesystem::path> pictures_;
  const OutputSettings& settings_;
  double interval_;
  std::uint64_t last_pass_;
  ProgressDisplay& progress_;
  double next_ = 0;  // seconds into the render
};

}  // namespace lanthorn::program
