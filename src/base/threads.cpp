// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/threads.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <iterator>
#include <latch>
#include <system_error>
#include <thread>
#include <vector>

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
    } catch (const std::exception&) {  // std::system_error or std::bad_alloc: no more threads
    }
    started = static_cast<unsigned>(threads.size());
    counted.count_down();
  }
  // The system still counts a thread for a moment after it has been joined.
  for (int i = 0; i < 100 && threads_of_this_process() > before; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return started;
}

}  // namespace lanthorn
