// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "lanthorn/session.h"

namespace lanthorn::program {

/// Progress on standard error: one line that is redrawn on a terminal, a plain line every ten seconds elsewhere.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);

  /// Shows `text()` if the last line is old enough. `fraction` of the work is done after `seconds`.
  void show(double fraction, double seconds, const std::function<std::string()>& text);
  /// Ends the redrawn line, if there is one.
  void finish();

 private:
  bool quiet_;
  bool terminal_;
  bool line_open_ = false;
  double shown_at_ = -1;  // seconds into the work
  double shown_fraction_ = 0;
};

/// The progress of a render.
class ProgressDisplay {
 public:
  /// `stop` is the work to do, `start` the part that is done already. `quiet` shows nothing.
  ProgressDisplay(const StopRule& stop, const RenderState& start, bool quiet);

  void update(const RenderState& state, const RenderStatistics& statistics);
  void finish() { line_.finish(); }

 private:
  std::string text(const RenderStatistics& statistics, double fraction) const;
  double fraction_done(const RenderStatistics& statistics, std::uint64_t state_passes) const;
  double fraction_of_noise(const RenderStatistics& statistics, std::uint64_t state_passes) const;

  std::uint64_t passes_to_do_;
  std::optional<double> seconds_, noise_;
  ProgressLine line_;
};

/// Time left if `fraction` of the work took `seconds`.
double seconds_left(double fraction, double seconds);
/// Seconds as "1:02:03", "2:03" or "4 s".
std::string format_duration(double seconds);
/// A count with a decimal prefix: "1.25 M".
std::string format_count(double count);

}  // namespace lanthorn::program
