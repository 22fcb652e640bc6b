// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Limits that control groups (containers, systemd services, batch systems) set for this process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace lanthorn {

/// The strictest limits of the process's control group and all its ancestors; nullopt: none.
struct GroupLimits {
  std::optional<double> cores;               ///< CPU seconds per second, such as 1.5
  std::optional<std::uint64_t> memory;       ///< bytes
  std::optional<std::uint64_t> memory_left;  ///< bytes that can still be allocated
};

/// Reads the limits of control groups, versions 1 and 2, wherever they are mounted. Cached files count as free memory.
/// Unreadable limits count as none. `root`: location of /proc and /sys, for tests.
GroupLimits group_limits(const std::filesystem::path& root = "/");

/// The number after `key` in a file of lines "key number"; nullopt if the key is missing.
std::optional<std::uint64_t> find_number(const std::filesystem::path& file, std::string_view key);

}  // namespace lanthorn
