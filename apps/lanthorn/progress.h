// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "lanthorn/session.h"

namespace lanthorn::program {

/// Progress on standard error: one redrawn line on a terminal, otherwise a plain line every ten seconds.
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
  double shown_at_ = -1;  // seconds since the work began
  double shown_fraction_ = 0;
};

/// The progress of a render.
class ProgressDisplay {
 public:
  /// `stop` defines the total work. `quiet` shows nothing.
  ProgressDisplay(const StopRule& stop, bool quiet);

  void update(const RenderState& state, const RenderStatistics& statistics);
  void finish() { line_.finish(); }

 private:
  StopRule stop_;
  ProgressLine line_;
};

/// Estimated remaining seconds if `fraction` of the work took `seconds`.
double seconds_left(double fraction, double seconds);
/// A count with a decimal prefix: "1.25 M".
std::string format_count(double count);

}  // namespace lanthorn::program
