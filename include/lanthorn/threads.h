// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace lanthorn {

/// While it lives, limits the threads of all parallel loops of this process. Results never depend on it.
class ThreadLimit {
 public:
  /// 0: all cores. Uses fewer threads if the system grants fewer.
  explicit ThreadLimit(unsigned threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

/// Number of threads that a parallel loop started by the calling thread may use.
unsigned thread_count();

}  // namespace lanthorn
