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

/// Measures the stages of a frame by the GPU's clock. Frames are read some frames later, so that nobody waits.
class StageTimer {
 public:
  /// Begins a frame: forgets the stages of one that nobody has collected.
  void begin_frame();
  /// Begins a stage, and ends the one before it.
  void begin(std::string stage);
  /// Ends the last stage of the frame.
  void end();
  /// Times of the stages of the frame that has ended last, in order; waits for the GPU. Empties the timer.
  std::vector<StageTime> collect();

 private:
  void stamp();

  std::vector<std::string> stages_;
  std::vector<Object<delete_query>> queries_;  // reused from frame to frame
  std::size_t stamped_ = 0;
};

}  // namespace lanthorn::gl
