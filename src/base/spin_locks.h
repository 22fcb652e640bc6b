// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <thread>

namespace lanthorn {

/// Locks for the items of an array; each lock covers groups of neighbouring items. For critical sections of a few
/// nanoseconds that rarely collide: a waiting thread spins. A copy gets its own locks, all free.
class SpinLocks {
 public:
  SpinLocks() : locks_(std::make_unique<Lock[]>(count)) {}
  SpinLocks(const SpinLocks&) : SpinLocks() {}
  SpinLocks& operator=(const SpinLocks&) { return *this; }
  ~SpinLocks() = default;

  /// Holds the lock of item `index` during its lifetime.
  class Guard {
   public:
    Guard(const SpinLocks& locks, std::size_t index) : lock_(locks.locks_[index / group % count].flag) {
      while (lock_.test_and_set(std::memory_order_acquire)) std::this_thread::yield();
    }
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;
    ~Guard() { lock_.clear(std::memory_order_release); }

   private:
    std::atomic_flag& lock_;
  };

 private:
  static constexpr std::size_t count = 1021;  // a prime, so that groups in one column of a picture use different locks
  static constexpr std::size_t group = 16;
  struct alignas(64) Lock {  // one cache line each: avoids false sharing
    std::atomic_flag flag;
  };
  std::unique_ptr<Lock[]> locks_;
};

}  // namespace lanthorn
