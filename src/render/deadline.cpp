// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/deadline.h"

#include <algorithm>
#include <system_error>

namespace lanthorn {

Deadline::Deadline(const std::atomic<bool>* drop, std::optional<Clock::time_point> time) : drop_(drop) {
  if (!time) return;
  try {
    thread_ = std::thread([this, at = *time] { watch(at); });
  } catch (const std::system_error&) {  // the limit of threads: see `flag`
  }
}

Deadline::~Deadline() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  ending_.notify_all();
  thread_.join();
}

// A signal handler may set `drop_`, so this thread must look at it now and then.
void Deadline::watch(Clock::time_point time) {
  constexpr std::chrono::milliseconds interval{10};
  std::unique_lock lock(mutex_);
  while (!ends_ && !(drop_ && drop_->load()) && Clock::now() < time)
    ending_.wait_until(lock, drop_ ? std::min(time, Clock::now() + interval) : time);
  is_set_ = !ends_;
}

}  // namespace lanthorn
