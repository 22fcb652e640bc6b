// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/threads.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/version.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iterator>
#include <latch>
#include <list>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include "base/control_group.h"
#include "lanthorn/threads.h"

namespace lanthorn {

namespace {

std::ptrdiff_t threads_of_this_process() {
  std::error_code ignored;
  return std::distance(std::filesystem::directory_iterator("/proc/self/task", ignored), {});
}

}  // namespace

unsigned startable_threads(unsigned wanted) {
  const std::ptrdiff_t before = threads_of_this_process();
  unsigned started = 0;
  {
    std::latch counted(1);
    std::vector<std::jthread> threads;
    try {
      threads.reserve(wanted);
      while (threads.size() < wanted) threads.emplace_back([&] { counted.wait(); });
    } catch (const std::exception&) {  // std::system_error or std::bad_alloc: no more threads available
    }
    started = static_cast<unsigned>(threads.size());
    counted.count_down();
  }
  // The system may still count a thread for a moment after it has been joined.
  for (int i = 0; i < 100 && threads_of_this_process() > before; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return started;
}

// On Debian 12: OpenBLAS and OpenImageIO start a thread for each further core, and log4cplus starts four. A child
// process tries first.
unsigned threads_of_image_libraries() {
  const unsigned others = std::max(2u, std::thread::hardware_concurrency()) - 1;
  return others + others + 4 + 1;
}

namespace {

unsigned most_threads() { return static_cast<unsigned>(tbb::this_task_arena::max_concurrency()); }

// TBB throws if it cannot start a thread that its limit allows, even while a limit is being lifted. If threads are
// scarce, a permanent limit is therefore set.
std::size_t available_threads(unsigned threads) {
  const unsigned workers = std::min(threads, most_threads()) - 1;
  const unsigned left = threads_of_image_libraries(), started = startable_threads(workers + left);
  if (started < workers + left) {
    static const auto* const lasting =
        new tbb::global_control(tbb::global_control::max_allowed_parallelism, 1 + std::max(started, left) - left);
    static_cast<void>(lasting);
  }
  return threads;
}

}  // namespace

namespace {

// The limits of all live `ThreadLimit`s, oldest first. TBB itself would apply the smallest of them.
struct Limits {
  std::mutex mutex;
  std::list<std::size_t> living;
  std::optional<tbb::global_control> control;

  // Makes TBB use the newest limit. The caller holds the mutex.
  void apply() {
    control.reset();
    if (!living.empty()) control.emplace(tbb::global_control::max_allowed_parallelism, living.back());
  }
};

Limits& limits() {
  static Limits all;
  return all;
}

}  // namespace

struct ThreadLimit::Control {
  std::list<std::size_t>::iterator place;
};

ThreadLimit::ThreadLimit(unsigned threads) : control_(new Control) {
  const std::size_t limit = available_threads(threads > 0 ? threads : usable_threads());
  const std::lock_guard lock(limits().mutex);
  control_->place = limits().living.insert(limits().living.end(), limit);
  limits().apply();
}

ThreadLimit::~ThreadLimit() {
  const std::lock_guard lock(limits().mutex);
  limits().living.erase(control_->place);
  limits().apply();
}

unsigned allowed_threads() { return most_threads(); }  // TBB takes CPU affinity into account

std::string version_of_tbb() { return TBB_runtime_version(); }

unsigned threads_for(unsigned cores, std::optional<double> quota) {
  return static_cast<unsigned>(std::max(1.0, std::ceil(std::min<double>(cores, quota.value_or(cores)))));
}

unsigned usable_threads() { return threads_for(allowed_threads(), group_limits().cores); }

unsigned thread_count() {
  return static_cast<unsigned>(
      std::min<std::size_t>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism),
                            static_cast<std::size_t>(tbb::this_task_arena::max_concurrency())));
}

}  // namespace lanthorn
