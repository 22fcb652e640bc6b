// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace lanthorn {

/// Limits the threads of all parallel loops of this process during its lifetime; the newest limit applies. Does not
/// change any result.
class ThreadLimit {
 public:
  /// 0: as many as CPU affinity and control groups allow. Never more than the affinity's cores or than can be started.
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
