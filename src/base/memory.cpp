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
#include <limits>
#include <string_view>

namespace lanthorn {

namespace {

namespace fs = std::filesystem;

// The number after `key` in a file of lines "key number"; nullopt if the key is missing.
std::optional<std::uint64_t> find_number(const fs::path& file, std::string_view key) {
  std::ifstream in(file);
  for (std::string name; in >> name; in.ignore(std::numeric_limits<std::streamsize>::max(), '\n')) {
    std::uint64_t value = 0;
    if (name == key && in >> value) return value;
  }
  return {};
}

std::optional<std::uint64_t> read_number(const fs::path& file) {
  std::uint64_t value = 0;
  if (std::ifstream in(file); in >> value) return value;
  return {};  // also for "max"
}

std::optional<std::uint64_t> left_by_machine() {
  if (const auto kibibytes = find_number("/proc/meminfo", "MemAvailable:")) return *kibibytes * 1024;
  return {};
}

// Memory that the control group may still take. Cached files count as used, but can be reclaimed.
std::optional<std::uint64_t> left_by_group(const fs::path& group) {
  const auto most = read_number(group / "memory.max"), used = read_number(group / "memory.current");
  if (!most || !used) return {};
  const std::uint64_t held = *used - std::min(*used, find_number(group / "memory.stat", "inactive_file").value_or(0));
  return *most - std::min(*most, held);
}

std::optional<std::uint64_t> left_by_groups() {
  const fs::path root = "/sys/fs/cgroup";
  std::string line;
  constexpr std::string_view unified = "0::/";
  for (std::ifstream in("/proc/self/cgroup"); std::getline(in, line) && !line.starts_with(unified);) {
  }
  if (!line.starts_with(unified)) return {};
  std::optional<std::uint64_t> least;
  for (fs::path group = root / line.substr(unified.size());; group = group.parent_path()) {
    if (const auto left = left_by_group(group)) least = std::min(*left, least.value_or(*left));
    if (group == root || !group.has_relative_path()) return least;
  }
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
  for (const auto& left : {left_by_machine(), left_by_groups(), left_by_limit()})
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
