// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Limits the number of threads independently of TBB: Embree, which has one thread in builds for ThreadSanitizer, sets
// TBB's limit to one for the whole program.
#pragma once

#include <cstddef>
#include <mutex>
#include <set>

#include "task_arena.h"

namespace tbb {

/// During its lifetime, loops use at most `limit` threads.
class global_control {
 public:
  enum parameter { max_allowed_parallelism };

  global_control(parameter /*the only one*/, std::size_t limit) {
    const std::lock_guard lock(mutex);
    place_ = limits.insert(limit);
  }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;
  ~global_control() {
    const std::lock_guard lock(mutex);
    limits.erase(place_);
  }
  static std::size_t active_value(parameter /*the only one*/) {
    const std::lock_guard lock(mutex);
    return limits.empty() ? static_cast<std::size_t>(this_task_arena::max_concurrency()) : *limits.begin();
  }

 private:
  inline static std::mutex mutex;
  inline static std::multiset<std::size_t> limits;
  std::multiset<std::size_t>::iterator place_;
};

}  // namespace tbb
