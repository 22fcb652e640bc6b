// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Replaces TBB's headers in builds for ThreadSanitizer, and implements the functions that parallel.cpp and
// parallel_sort.h need with plain threads. Debian's TBB is not compiled for ThreadSanitizer, which therefore cannot see
// the order in which TBB runs tasks and would report false races. Nested loops run on one thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "lanthorn/threads.h"

namespace tbb {

struct task_group_context {
  void capture_fp_settings() {}
};

inline thread_local bool is_in_loop = false;

/// Indices are taken without synchronisation between the threads, which would hide races.
template <class Index, class Body>
void parallel_for(Index begin, Index end, const Body& body, task_group_context& /*of all threads the same*/) {
  std::atomic<Index> next{begin};
  std::mutex mutex;
  std::exception_ptr problem;
  const auto work = [&] {
    const bool outer = std::exchange(is_in_loop, true);
    try {
      for (Index i; (i = next.fetch_add(1, std::memory_order_relaxed)) < end;) body(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!problem) problem = std::current_exception();
      next.store(end, std::memory_order_relaxed);
    }
    is_in_loop = outer;
  };
  {
    std::vector<std::jthread> threads;
    const std::size_t useful = begin < end ? static_cast<std::size_t>(end - begin) : 0;
    const std::size_t count = is_in_loop ? 1 : std::min<std::size_t>(useful, lanthorn::thread_count());
    while (threads.size() + 1 < count) threads.emplace_back(work);
    work();
  }
  if (problem) std::rethrow_exception(problem);
}

/// Of one number each.
template <class Index>
class blocked_range {
 public:
  blocked_range(Index begin, Index end, std::size_t /*one*/) : begin_(begin), end_(end) {}
  Index begin() const { return begin_; }
  Index end() const { return end_; }

 private:
  Index begin_, end_;
};
template <class Index, class Body>
void parallel_for(const blocked_range<Index>& range, const Body& body, task_group_context& context) {
  parallel_for(
      range.begin(), range.end(), [&](Index i) { body(blocked_range<Index>(i, i + 1, 1)); }, context);
}

template <class Iterator>
void parallel_sort(Iterator begin, Iterator end) {
  std::sort(begin, end);
}

}  // namespace tbb
