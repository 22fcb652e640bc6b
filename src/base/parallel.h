// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The only file besides threads.cpp that includes TBB. Every parallel computation in Lanthorn is a loop over chunks
// whose bounds do not depend on the number of threads, so results do not either.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_group.h>

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

/// Makes a loop's tasks treat denormal numbers as its caller does. Without its own context, a loop would treat them as
/// its thread did on first using TBB; if that was inside Embree, which flushes them to zero, results would differ.
struct LoopContext {
  tbb::task_group_context of_tasks;
  LoopContext() { of_tasks.capture_fp_settings(); }
};
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

/// Calls `body(i)` for every i in [begin, end), in any order and on any thread.
template <class Index, class Body>
void parallel_for(Index begin, Index end, Body&& body) {
  const auto* const flag = detail::stop_flag;
  detail::LoopContext context;
  if (!flag) return tbb::parallel_for(begin, end, body, context.of_tasks);
  tbb::parallel_for(
      begin, end,
      [&](Index i) {
        const StopScope scope(flag);
        stop_point();
        body(i);
      },
      context.of_tasks);
}

/// Splits [0, count) into chunks of `chunk` items (the last may be shorter) and calls `body(chunk_index, begin, end)`
/// for each, in any order and on any thread. Chunk bounds depend only on `count` and `chunk`.
template <class Body>
void parallel_chunks(std::size_t count, std::size_t chunk, Body&& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  const auto* const flag = detail::stop_flag;
  detail::LoopContext context;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, chunks, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        const StopScope scope(flag);
        for (std::size_t c = range.begin(); c != range.end(); ++c) {
          stop_point();
          body(c, c * chunk, std::min(count, (c + 1) * chunk));
        }
      },
      context.of_tasks);
}

/// Sorts values in parallel. They must be distinct, so that the result does not depend on the threads.
template <class Values>
void parallel_sort(Values& values) {
  tbb::parallel_sort(values.begin(), values.end());
}

/// Runs both callables, possibly concurrently; returns when both are done.
template <class A, class B>
void parallel_invoke(A&& a, B&& b) {
  const auto* const flag = detail::stop_flag;
  detail::LoopContext context;
  tbb::parallel_invoke(
      [&] {
        const StopScope scope(flag);
        stop_point();
        a();
      },
      [&] {
        const StopScope scope(flag);
        stop_point();
        b();
      },
      context.of_tasks);
}

}  // namespace lanthorn
