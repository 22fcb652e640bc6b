// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "gl/timer.h"

#include <utility>

namespace lanthorn::gl {

void StageTimer::stamp() {
  if (stamped_ == queries_.size()) {
    GLuint name = 0;
    glCreateQueries(GL_TIMESTAMP, 1, &name);
    queries_.emplace_back(name);
  }
  glQueryCounter(queries_[stamped_++].name(), GL_TIMESTAMP);
  if (is_software_) glFinish();
}

void StageTimer::begin_frame() {
  stages_.clear();
  stamped_ = 0;
}

void StageTimer::begin(std::string stage) {
  stages_.push_back(std::move(stage));
  stamp();
}

void StageTimer::end() { begin({}); }

std::vector<StageTime> StageTimer::collect() {
  std::vector<StageTime> times;
  const auto nanoseconds = [&](std::size_t i) {
    GLuint64 value = 0;
    glGetQueryObjectui64v(queries_[i].name(), GL_QUERY_RESULT, &value);
    return value;
  };
  for (std::size_t i = 0; i + 1 < stamped_; ++i)
    if (!stages_[i].empty())
      times.push_back({std::move(stages_[i]), 1e-6 * static_cast<double>(nanoseconds(i + 1) - nanoseconds(i))});
  begin_frame();
  return times;
}

}  // namespace lanthorn::gl
