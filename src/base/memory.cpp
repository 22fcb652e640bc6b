// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "base/control_group.h"

namespace lanthorn {

namespace {

namespace fs = std::filesystem;

std::optional<std::uint64_t> read_number(const fs::path& file) {
  std::uint64_t value = 0;
  if (std::ifstream in(file); in >> value) return value;
  return {};  // also for "max"
}

std::optional<std::uint64_t> left_by_machine() {
  if (const auto kibibytes = find_number("/proc/meminfo", "MemAvailable:")) return *kibibytes * 1024;
  return {};
}

std::optional<std::uint64_t> left_by_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return {};
  const auto pages = read_number("/proc/self/statm");
  if (!pages) return {};
  const std::uint64_t used = *pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)), most = limit.rlim_cur;
  return most - std::min(most, used);
}

}  // namespace

std::optional<std::uint64_t> available_memory() {
  std::optional<std::uint64_t> least;
  for (const auto& left : {left_by_machine(), group_limits().memory_left, left_by_limit()})
    if (left) least = std::min(*left, least.value_or(*left));
  return least;
}

std::string memory_text(double bytes) {
  constexpr std::array units{"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  if (bytes < 1024) return fmt::format("{:.0f} bytes", bytes);
  std::size_t unit = 0;
  for (bytes /= 1024; bytes >= 1024 && unit + 1 < units.size(); bytes /= 1024) ++unit;
  return fmt::format("{:.{}f} {}", bytes, bytes < 10 ? 1 : 0, units[unit]);
}

void require_memory(double bytes, const SourceLocation& where, const std::string& what) {
  constexpr double granted = 64 << 20;
  if (bytes <= granted) return;
  const auto available = available_memory();
  if (available && bytes > static_cast<double>(*available))
    throw Error(where, fmt::format("{} takes {} of memory, but there are only {}", what, memory_text(bytes),
                                   memory_text(static_cast<double>(*available))));
}

}  // namespace lanthorn
