// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace lanthorn {

/// Limits the threads of all parallel loops of this process while it lives; the newest counts. Changes no result.
class ThreadLimit {
 public:
  /// 0: what CPU affinity and control groups leave. Never more than the cores of the affinity or what can be started.
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
