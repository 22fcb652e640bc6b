// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gl/object.h"

namespace lanthorn::gl {

inline void delete_query(GLuint name) { glDeleteQueries(1, &name); }

/// Time that the GPU took for one stage of a frame.
struct StageTime {
  std::string stage;
  double milliseconds = 0;
};

/// Measures the stages of a frame by the GPU's clock, which nobody waits for before `collect`.
class StageTimer {
 public:
  /// `is_software`: of the driver. Such drivers compute at once, and draw when they must: their stages begin when what
  /// was asked for before is done.
  explicit StageTimer(bool is_software) : is_software_(is_software) {}

  /// Begins a frame: forgets the stages of one that nobody has collected.
  void begin_frame();
  /// Begins a stage, and ends the one before it.
  void begin(std::string stage);
  /// Ends a stage; what follows belongs to none until the next begins.
  void end();
  /// Times of the stages of the frame that has ended last, in order; waits for the GPU. Empties the timer.
  std::vector<StageTime> collect();

 private:
  void stamp();

  bool is_software_;
  std::vector<std::string> stages_;            // empty: none of the stages
  std::vector<Object<delete_query>> queries_;  // reused from frame to frame
  std::size_t stamped_ = 0;
};

}  // namespace lanthorn::gl
