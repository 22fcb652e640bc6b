// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

namespace lanthorn {

/// A flag for `StopScope` that is set when a point in time is reached, or soon after another flag is set.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  /// `drop` may be null. Without a time there is no thread, and the flag is `drop` itself. If the thread cannot be
  /// started, the flag is `drop`, too: loops then run beyond the time.
  Deadline(const std::atomic<bool>* drop, std::optional<Clock::time_point> time);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  const std::atomic<bool>* flag() const { return thread_.joinable() ? &is_set_ : drop_; }

 private:
  void watch(Clock::time_point time);

  const std::atomic<bool>* drop_;
  std::atomic<bool> is_set_{false};
  std::mutex mutex_;
  std::condition_variable ending_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace lanthorn
