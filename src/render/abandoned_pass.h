// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Abandoned passes: the deadline that ends them, and the restoration of the film.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "film/film.h"
#include "lanthorn/session.h"
#include "render/state.h"

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

/// A film as it was before a pass.
class PassUndo {
 public:
  explicit PassUndo(Undo rule) : rule_(rule) {}

  /// Call before each pass, with the duration of the previous one, if there was one. Returns whether this pass can be
  /// undone.
  bool begin(const RenderState& state, std::optional<double> pass_seconds);
  /// Restores the state as it was at `begin`, which must have returned true. With Undo::never the state is left without
  /// passes and cannot be used.
  void restore(RenderState& state);

 private:
  bool is_worth_it(const RenderState& state, std::optional<double> pass_seconds) const;
  bool copy(const Film& film);

  Undo rule_;
  std::optional<Film> copy_;
  std::optional<double> copy_seconds_;
};

}  // namespace lanthorn
