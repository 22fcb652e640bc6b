// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The only file that includes TBB. Everything parallel in Lanthorn is a loop over chunks whose borders never depend on
// the number of threads, so that results do not either.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

#include "base/threads.h"

namespace lanthorn {

/// Limits the threads that all parallel loops of this process may use, for as long as it lives. 0: all cores. Fewer
/// where the system does not give as many.
class ThreadLimit {
 public:
  explicit ThreadLimit(unsigned threads)
      : control_(tbb::global_control::max_allowed_parallelism, available(threads > 0 ? threads : most())) {}

 private:
  static unsigned most() { return static_cast<unsigned>(tbb::this_task_arena::max_concurrency()); }
  // TBB throws where it cannot start a thread that it has been allowed, even while a limit is lifted: then one stays
  // for good.
  static std::size_t available(unsigned threads) {
    const unsigned workers = std::min(threads, most()) - 1;
    const unsigned started = startable_threads(workers);
    if (started < workers) {
      static const auto* const lasting =
          new tbb::global_control(tbb::global_control::max_allowed_parallelism, 1 + started);
      static_cast<void>(lasting);
    }
    return threads;
  }

  tbb::global_control control_;
};

/// Number of threads that a parallel loop started here may use.
inline unsigned thread_count() {
  return static_cast<unsigned>(
      std::min<std::size_t>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism),
                            static_cast<std::size_t>(tbb::this_task_arena::max_concurrency())));
}

/// Calls `body(i)` for every i in [begin, end), in any order and on any thread.
template <class Index, class Body>
void parallel_for(Index begin, Index end, Body&& body) {
  tbb::parallel_for(begin, end, body);
}

/// Cuts [0, count) into chunks of `chunk` items (the last may be shorter) and calls `body(chunk_index, begin, end)` for
/// each, in any order and on any thread. Chunk borders depend on `count` and `chunk` alone.
template <class Body>
void parallel_chunks(std::size_t count, std::size_t chunk, Body&& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunks, 1), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t c = range.begin(); c != range.end(); ++c) body(c, c * chunk, std::min(count, (c + 1) * chunk));
  });
}

/// Sorts values that are all different, so that the result does not depend on how the work was shared.
template <class Values>
void parallel_sort(Values& values) {
  tbb::parallel_sort(values.begin(), values.end());
}

/// Runs both callables, possibly at the same time; returns when both are done.
template <class A, class B>
void parallel_invoke(A&& a, B&& b) {
  tbb::parallel_invoke(a, b);
}

}  // namespace lanthorn
