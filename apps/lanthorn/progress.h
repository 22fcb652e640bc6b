// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
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
  /// `stop` is the work to do. `quiet` shows nothing.
  ProgressDisplay(const StopRule& stop, bool quiet);

  void update(const RenderState& state, const RenderStatistics& statistics);
  void finish() { line_.finish(); }

 private:
  StopRule stop_;
  ProgressLine line_;
};

/// Time left if `fraction` of the work took `seconds`.
double seconds_left(double fraction, double seconds);
/// A count with a decimal prefix: "1.25 M".
std::string format_count(double count);

}  // namespace lanthorn::program
