// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Every parallel computation in Lanthorn is a loop over chunks whose bounds do not depend on the number of threads, so
// results do not either. TBB's headers are kept out of this one, which is included nearly everywhere.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <utility>

#include "lanthorn/threads.h"

namespace lanthorn {

/// Thrown by loops that are asked to stop (`StopScope`). Their results are incomplete and must be discarded.
struct Stopped {};

namespace detail {
inline thread_local const std::atomic<bool>* stop_flag = nullptr;
}  // namespace detail

/// During its lifetime, the parallel loops that its thread starts, and all loops nested in them, throw `Stopped`
/// between chunks once the flag is set (by any thread or a signal handler). Null: loops cannot be stopped.
class StopScope {
 public:
  explicit StopScope(const std::atomic<bool>* flag) : before_(std::exchange(detail::stop_flag, flag)) {}
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;
  ~StopScope() { detail::stop_flag = before_; }

 private:
  const std::atomic<bool>* before_;
};

/// For long loops within a chunk: throws `Stopped` if the loops are asked to stop. Costs about a nanosecond.
inline void stop_point() {
  if (detail::stop_flag && detail::stop_flag->load(std::memory_order_relaxed)) throw Stopped{};
}

namespace detail {
/// Calls `call(body, begin, end)` for parts of [0, count), in any order and on any thread. Every thread has the
/// caller's stop flag, and treats denormal numbers as the caller does.
void for_parts(std::size_t count, const void* body, void (*call)(const void* body, std::size_t begin, std::size_t end));
/// Calls `body(i)` for all i < count, between points where the loop may stop.
template <class Body>
void for_all(std::size_t count, const Body& body) {
  for_parts(count, &body, [](const void* b, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      stop_point();
      (*static_cast<const Body*>(b))(i);
    }
  });
}
}  // namespace detail

/// Calls `body(i)` for every i in [begin, end), in any order and on any thread.
template <class Index, class Body>
void parallel_for(Index begin, Index end, Body&& body) {
  if (begin < end)
    detail::for_all(static_cast<std::size_t>(end - begin),
                    [&](std::size_t i) { body(static_cast<Index>(begin + static_cast<Index>(i))); });
}

/// Splits [0, count) into chunks of `chunk` items (the last may be shorter) and calls `body(chunk_index, begin, end)`
/// for each, in any order and on any thread. Chunk bounds depend only on `count` and `chunk`.
template <class Body>
void parallel_chunks(std::size_t count, std::size_t chunk, Body&& body) {
  detail::for_all((count + chunk - 1) / chunk,
                  [&](std::size_t c) { body(c, c * chunk, std::min(count, (c + 1) * chunk)); });
}

/// Runs both callables, possibly concurrently; returns when both are done.
template <class A, class B>
void parallel_invoke(A&& a, B&& b) {
  detail::for_all(2, [&](std::size_t i) { i == 0 ? a() : b(); });
}

}  // namespace lanthorn
