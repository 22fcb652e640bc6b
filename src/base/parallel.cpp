// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

namespace lanthorn {

void detail::for_parts(std::size_t count, const void* body, void (*call)(const void*, std::size_t, std::size_t)) {
  const auto* const flag = stop_flag;
  // Without its own context, a loop would treat denormal numbers as its thread did on first using TBB; if that was
  // inside Embree, which flushes them to zero, results would differ.
  tbb::task_group_context context;
  context.capture_fp_settings();
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, 1),
      [&](const tbb::blocked_range<std::size_t>& part) {
        const StopScope scope(flag);
        call(body, part.begin(), part.end());
      },
      context);
}

}  // namespace lanthorn
