// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gl/object.h"

namespace lanthorn::gl {

inline void delete_query(GLuint name) { glDeleteQueries(1, &name); }

/// GPU time of one stage of a frame.
struct StageTime {
  std::string stage;
  double milliseconds = 0;
};

/// Measures the stages of a frame with the GPU's clock, without waiting before `collect`.
class StageTimer {
 public:
  /// `is_software`: from the driver. Software drivers run compute shaders immediately but defer drawing: for these,
  /// each stage boundary waits until all earlier work is done.
  explicit StageTimer(bool is_software) : is_software_(is_software) {}

  /// Begins a frame, discarding uncollected stages of an earlier one.
  void begin_frame();
  /// Begins a stage, ending the one before it.
  void begin(std::string stage);
  /// Ends a stage; commands belong to no stage until the next one begins.
  void end();
  /// Times of the stages of the last completed frame, in order; waits for the GPU. Empties the timer.
  std::vector<StageTime> collect();

 private:
  void stamp();

  bool is_software_;
  std::vector<std::string> stages_;            // empty name: no stage
  std::vector<Object<delete_query>> queries_;  // reused from frame to frame
  std::size_t stamped_ = 0;
};

}  // namespace lanthorn::gl
