// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Updates the output pictures while the render runs.
#pragma once

#include <filesystem>
#include <vector>

#include "lanthorn/session.h"
#include "output.h"
#include "progress.h"

namespace lanthorn::program {

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
